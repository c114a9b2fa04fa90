"""The report's style sheet, for screen and paper."""

STYLE = """
@page { size: A4; margin: 16mm 14mm; }
body { font: 10pt/1.4 "Helvetica Neue", Arial, sans-serif; color: #1d2329; }
body { max-width: 182mm; margin: 8mm auto; }
h1 { font-size: 18pt; margin: 0 0 2mm; }
h2 { font-size: 12.5pt; margin: 7mm 0 2mm; border-bottom: 1px solid #b9c2cb; break-after: avoid; }
h3 { font-size: 10.5pt; margin: 4mm 0 1.5mm; break-after: avoid; }
.verdict { font-size: 11.5pt; }
table { border-collapse: collapse; width: 100%; margin: 1.5mm 0 3mm; font-size: 8.5pt; }
th { text-align: left; color: #55606b; font-weight: 600; border-bottom: 1px solid #b9c2cb; }
th, td { padding: 0.7mm 2.5mm 0.7mm 0; vertical-align: top; overflow-wrap: break-word; }
tr { break-inside: avoid; }
tbody tr:nth-child(even) { background: #f4f6f8; }
.facts td:first-child { width: 46mm; color: #55606b; }
.broken td { color: #b3261e; font-weight: 600; }
svg { width: 100%; box-sizing: border-box; border: 1px solid #d5dbe1; break-inside: avoid; }
svg text { font: 11px Arial, sans-serif; fill: #3a444e; }
.risk { fill: #f7dedb; stroke: #c8443a; background: #f7dedb; }
.contingency { fill: #fbe9c8; stroke: #d18a00; background: #fbe9c8; }
.flight { fill: #cfe3fb; stroke: #2a6cc0; background: #cfe3fb; }
.zone { fill: none; stroke: #3a444e; stroke-dasharray: 5 3; }
.zone.out { fill: #d7a3a0; fill-opacity: 0.6; }
.house { fill: #a8a097; }
.pad { fill: #1d2329; }
.seat { fill: #7a3fb0; }
.axis { fill: none; stroke: #3a444e; }
.grid { stroke: #e4e8ec; }
.north { fill: #3a444e; }
.needed { stroke: #c8443a; stroke-dasharray: 5 3; }
.curve { fill: none; stroke: #2a6cc0; stroke-width: 1.5; }
.legend span { display: inline-block; width: 4mm; height: 3mm; margin: 0 1mm 0 3mm; }
.legend span { border: 1px solid #8a949e; }
.legend span.out { border-style: dashed; }
.legend span.house { background: #a8a097; }
* { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
""".strip()
