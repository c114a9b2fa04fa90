// Validates a glTF file by Khronos' own validator, npm package gltf-validator, which is no part of this tree.
// Argument: the file. It runs from where GLTF_VALIDATOR says, a package's folder, or from wherever node finds it.
import { createRequire } from "node:module";
import { readFile } from "node:fs/promises";
import { resolve } from "node:path";

const NOT_FOUND = 3;
const require = createRequire(import.meta.url);
const named = process.env.GLTF_VALIDATOR;
let validator;
try {
  validator = require(named ? resolve(named) : "gltf-validator");
} catch (error) {
  console.error(error.message.split("\n")[0]);
  process.exit(NOT_FOUND);
}
const { issues } = await validator.validateBytes(new Uint8Array(await readFile(process.argv[2])));
console.log(JSON.stringify(issues));
