"""What tests share: missions and plans made by hand, readers of outputs, and judges of plans."""
