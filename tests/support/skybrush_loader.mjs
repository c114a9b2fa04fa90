// Plays a show file by Skybrush's own loader. Arguments: the file, the times; prints what the loader finds.
// The loader is what SHOW_FORMAT_LOADER names, a module or a package's folder, or else what node finds.
import { createRequire } from "node:module";
import { readFile } from "node:fs/promises";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";

const NOT_FOUND = 3;
const { resolve: find } = createRequire(import.meta.url);
const named = process.env.SHOW_FORMAT_LOADER;
let found;
try {
  found = await import(pathToFileURL(find(named ? resolve(named) : "@skybrush/show-format")));
} catch (error) {
  console.error(error.message.split("\n")[0]);
  process.exit(NOT_FOUND);
}
const loader = found.default ?? found;

const [, , path, sampled] = process.argv;
if (path !== undefined) {
  const show = await loader.loadCompiledShow(await readFile(path)); // throws what is wrong with it
  const drones = show.swarm.drones.map(({ settings }) => settings);
  const { environment, meta, settings } = show;
  const cameras = loader.getCamerasFromShowSpecification(show).map(({ name }) => name);
  const played = drones.map((drone) => play(drone, JSON.parse(sampled)));
  console.log(JSON.stringify({ environment, meta, settings, cameras, played, names: drones.map((d) => d.name) }));
}

function play({ trajectory, lights, yawControl }, times) {
  const flight = loader.createTrajectoryPlayer(trajectory);
  const light = loader.createLightProgramPlayer(lights);
  if (yawControl !== undefined) loader.createYawControlPlayer(yawControl); // throws what is wrong with it
  return times.map((t) => {
    const { x, y, z } = flight.getPositionAt(t, {});
    const { x: u, y: v, z: w } = flight.getVelocityAt(t, {});
    return [x, y, z, u, v, w, ...light.evaluateColorAt(t, [0, 0, 0])];
  });
}
