// Plays a show file by Skybrush's own loader. Arguments: the file, the times; prints places and colours.
import { readFile } from "node:fs/promises";
import * as loader from "@skybrush/show-format";

const [, , path, sampled] = process.argv;
const { loadCompiledShow, createTrajectoryPlayer, createLightProgramPlayer } = loader.default ?? loader;
const show = await loadCompiledShow(await readFile(path));
const times = JSON.parse(sampled);
const drones = show.swarm.drones.map(({ settings }) => {
  const flight = createTrajectoryPlayer(settings.trajectory);
  const light = createLightProgramPlayer(settings.lights);
  return times.map((t) => {
    const { x, y, z } = flight.getPositionAt(t, { x: 0, y: 0, z: 0 });
    return [x, y, z, ...light.evaluateColorAt(t, [0, 0, 0])];
  });
});
console.log(JSON.stringify({ type: show.environment.type, cameras: show.environment.cameras.length, drones }));
