// Runs a program for WASI in node, with the files of the working directory under its full path.
//     node run.mjs PROGRAM.wasm ARGUMENT…

import { readFileSync } from "node:fs";
import { WASI } from "node:wasi";

const [program, ...args] = process.argv.slice(2);
const here = process.cwd();
const wasi = new WASI({ version: "preview1", args: [program, ...args], preopens: { [here]: here }, returnOnExit: true });
const { instance } = await WebAssembly.instantiate(readFileSync(program), wasi.getImportObject());
process.exitCode = wasi.start(instance);
