// Whether the WebAssembly module draws what the programs draw: every picture of every variant, by every rasterizer.
//
//     node tests/live/pictures.mjs MODULE LIST
//
// LIST has a line for each picture: chapter, variant, rasterizer, frame, fingerprint. tests/chapters writes it.
import { readFileSync } from "node:fs";

const [module, list] = process.argv.slice(2);
const { instance } = await WebAssembly.instantiate(readFileSync(module), {});
const { memory, text, open, event, fingerprint } = instance.exports;

function write(line) {
    const bytes = new TextEncoder().encode(line);
    const place = text(bytes.length);
    new Uint8Array(memory.buffer, place, bytes.length).set(bytes);
}

const figures = new Map();
let count = 0;
const different = [];
for (const line of readFileSync(list, "utf8").trim().split("\n")) {
    const [chapter, variant, rasterizer, frame, expected] = line.split(" ");
    const name = `${chapter} ${variant}`;
    if (!figures.has(name)) {
        write(name);
        figures.set(name, open());
    }
    const figure = figures.get(name);
    for (const change of [`rasterizer ${rasterizer}`, `frame ${frame}`]) {
        write(change);
        event(figure);
    }
    const drawn = BigInt.asUintN(64, fingerprint(figure)).toString(16).padStart(16, "0");
    if (drawn !== expected) different.push(`${name} ${rasterizer} frame ${frame}`);
    count += 1;
}
for (const picture of different) console.error(`error: ${picture}: WebAssembly draws other pixels`);
console.log(`${count} pictures drawn by WebAssembly, ${different.length} differ from the programs'`);
if (count < 200) console.error(`error: ${list} has only ${count} pictures`);
process.exit(different.length || count < 200 ? 1 : 0);
