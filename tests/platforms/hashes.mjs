// Prints the state hashes of WebAssembly as the program toile-platforms prints those of a processor.
// Usage: node hashes.mjs MODULE.wasm FILE
import { readFileSync } from "node:fs";

const [module, worn] = process.argv.slice(2).map((path) => readFileSync(path));
const { exports } = (await WebAssembly.instantiate(module, {})).instance;
const hex = (hash) => BigInt.asUintN(64, hash).toString(16).padStart(16, "0");
for (const lanes of [1, 4]) {
    console.log(`skirt ${lanes} ${hex(exports.skirt_hash(lanes))}`);
}
const address = exports.file(worn.length);
new Uint8Array(exports.memory.buffer).set(worn, address);
for (const lanes of [1, 4]) {
    console.log(`dress ${lanes} ${hex(exports.dress_hash(lanes))}`);
}
