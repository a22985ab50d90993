// What TinyUSDZ makes of a USD file: a line with triangles, curves, and the bounds of their points.
//
//     node scripts/read-usda.mjs NODE_MODULES FILE
//
// Its package is built for browsers: it is told that it runs in one. Exit code 0; 1 where the file cannot be read, or
// counts of points, widths and curves do not fit each other.
import { readFileSync } from 'node:fs';
import { resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

const [modules, path] = process.argv.slice(2);
if (!path) {
  console.error('usage: node read-usda.mjs NODE_MODULES FILE');
  process.exit(2);
}

function refuse(why) {
  console.error(`${path}: ${why}`);
  process.exit(1);
}

const folder = resolve(modules, 'tinyusdz');
process.type = 'renderer';
globalThis.window = globalThis;
const { default: start } = await import(pathToFileURL(resolve(folder, 'tinyusdz.js')));
const native = await start({
  instantiateWasm(imports, done) {
    WebAssembly.instantiate(readFileSync(resolve(folder, 'tinyusdz.wasm')), imports)
      .then((made) => done(made.instance, made.module));
    return {};
  },
});
const usd = new native.TinyUSDZLoaderNative();
if (!usd.loadAsLayerFromBinary(readFileSync(path), path)) refuse(usd.error());

// As TinyUSDZ writes what it has read: what lies behind `name = [` of a prim.
function numbers(prim, name) {
  const found = prim.match(new RegExp(`${name} = \\[([^\\]]*)\\]`));
  return found ? found[1].replace(/[()]/g, ' ').split(',').map(Number) : refuse(`a prim without ${name}`);
}

// Places of a prim whose counts say how many there are; `indices` names them where there are more than places.
function counted(prim, countsName, indices) {
  const counts = numbers(prim, countsName);
  const total = counts.reduce((sum, count) => sum + count, 0);
  const places = numbers(prim, 'points');
  const named = indices ? numbers(prim, indices) : places.filter((_, i) => i % 3 === 0);
  if (named.length !== total) refuse(`${named.length} points where there are to be ${total}`);
  if (indices && named.some((index) => index < 0 || 3 * index >= places.length)) refuse('an index of no point');
  if (!places.every(Number.isFinite)) refuse('a point that is no number');
  return { counts, places };
}

let triangles = 0;
let curves = 0;
const low = [Infinity, Infinity, Infinity];
const high = [-Infinity, -Infinity, -Infinity];
for (const prim of usd.layerToString().split(/\bdef (?=BasisCurves |Mesh )/).slice(1)) {
  const mesh = prim.startsWith('Mesh');
  const { counts, places } = mesh ? counted(prim, 'faceVertexCounts', 'faceVertexIndices')
    : counted(prim, 'curveVertexCounts');
  if (!mesh && counts.some((count) => count % 3 !== 1)) refuse('a Bezier curve of an odd number of points');
  if (!mesh && !numbers(prim, 'widths').every((width) => width > 0)) refuse('a curve without a width');
  curves += mesh ? 0 : counts.length;
  triangles += mesh ? counts.reduce((sum, count) => sum + count - 2, 0) : 0;
  places.forEach((x, i) => {
    low[i % 3] = Math.min(low[i % 3], x);
    high[i % 3] = Math.max(high[i % 3], x);
  });
}
console.log(triangles, curves, ...[...low, ...high].map((x) => x.toFixed(5)));
