// Writes a product without what tells how and by which version it was made, for comparisons of builds.
//
//     node scripts/without-provenance.mjs FILE OUT
//
// Containers (.slots, .meso) become their chunks but `prov`, without the offsets and checksums that
// follow from it; PLY, OBJ, PNG and Draco files lose their entries; EXR files have their lines counted
// from the first one; GLB files lose an entry and the generator; JSON files and lines become a line a
// value. Everything else is written as it stands. Exit code 0; 1 where the file is cut or of no such kind.
import { closeSync, openSync, readFileSync, writeSync } from 'node:fs';
import { extname } from 'node:path';

const [path, out] = process.argv.slice(2);
if (!out) {
  console.error('usage: node without-provenance.mjs FILE OUT');
  process.exit(2);
}

// A zero-terminated name at `at`.
function nameAt(data, at) {
  return data.toString('latin1', at, data.indexOf(0, at));
}

// Layout: formats/file/container.h.
function container(data) {
  const count = data.readUInt32LE(24);
  const pieces = [data.subarray(0, 24)];
  for (let i = 0; i < count; i++) {
    const entry = 64 + 32 * i;
    const name = data.toString('latin1', entry, entry + 8).replace(/\0+$/, '');
    const offset = Number(data.readBigUInt64LE(entry + 8));
    const size = Number(data.readBigUInt64LE(entry + 16));
    if (name !== 'prov') pieces.push(Buffer.from(`\nchunk ${name} ${size}\n`), data.subarray(offset, offset + size));
  }
  return pieces;
}

// The comments before the first line of other kind, without those of provenance.
function textMesh(data, header, provenance) {
  const pieces = [];
  let at = 0;
  while (at < data.length) {
    const end = data.indexOf('\n', at) + 1 || data.length;
    const line = data.subarray(at, end);
    if (!header(line)) break;
    if (!provenance.test(line.toString('latin1', 0, 32))) pieces.push(line);
    at = end;
  }
  return [...pieces, data.subarray(at)];
}

function png(data) {
  const pieces = [data.subarray(0, 8)];
  for (let at = 8; at < data.length;) {
    const end = at + 12 + data.readUInt32BE(at);
    const text = data.toString('latin1', at + 4, at + 8) === 'iTXt' && nameAt(data, at + 8) === 'meso:provenance';
    if (!text) pieces.push(data.subarray(at, end));
    at = end;
  }
  return pieces;
}

// One part, in scan lines. Lines may be stored in any order, so that the table ends at the least offset.
function exr(data) {
  const pieces = [data.subarray(0, 8)];
  let at = 8;
  while (data[at] !== 0) {
    const type = data.indexOf(0, at) + 1;
    const size = data.indexOf(0, type) + 1;
    const end = size + 4 + data.readUInt32LE(size);
    if (nameAt(data, at) !== 'meso:provenance') pieces.push(data.subarray(at, end));
    at = end;
  }
  const offsets = [];
  for (let first = Infinity, entry = at + 1; entry < first; entry += 8) {
    offsets.push(Number(data.readBigUInt64LE(entry)));
    first = Math.min(first, offsets.at(-1));
  }
  const first = at + 1 + 8 * offsets.length;
  return [...pieces, Buffer.from(offsets.map((offset) => `\nline ${offset - first}`).join('')), data.subarray(first)];
}

function glb(data) {
  const end = 20 + data.readUInt32LE(12);
  const json = JSON.parse(data.toString('utf8', 20, end));
  delete json.asset?.generator;
  delete json.asset?.extras?.provenance;
  return [data.subarray(0, 8), Buffer.from(JSON.stringify(json)), data.subarray(end)];
}

// The metadata of a Draco file: numbers in groups of seven bits, entries of a key and a value.
function drc(data) {
  let at = 11;
  const number = () => {
    let value = 0;
    for (let shift = 0; ; shift += 7) {
      const byte = data[at++];
      value += (byte & 127) * 2 ** shift;
      if (byte < 128) return value;
    }
  };
  const skipName = () => (at += 1 + data[at]);
  const pieces = [];
  const metadata = () => {
    for (let entries = number(); entries > 0; entries--) {
      const start = at;
      skipName();
      const key = data.toString('latin1', start + 1, at);
      const size = number();
      at += size;
      if (key !== 'provenance') pieces.push(data.subarray(start, at));
    }
    for (let children = number(); children > 0; children--) {
      const start = at;
      skipName();
      pieces.push(data.subarray(start, at));
      metadata();
    }
  };
  if (data.readUInt16LE(9) & 0x8000) {
    for (let attributes = number(); attributes > 0; attributes--) {
      pieces.push(Buffer.from(`\nattribute ${number()}\n`));
      metadata();
    }
    metadata();
  }
  return [data.subarray(0, 11), ...pieces, data.subarray(at)];
}

// A line a value, its path before it, in the file's order: whoever compares sees what was added.
function json(data) {
  const lines = [];
  const list = (value, name) => {
    if (value === null || typeof value !== 'object') {
      lines.push(`${name} ${JSON.stringify(value)}\n`);
      return;
    }
    if (Object.keys(value).length === 0) lines.push(`${name} ${JSON.stringify(value)}\n`);
    for (const [key, child] of Object.entries(value))
      if (key !== 'provenance') list(child, `${name}/${key}`);
  };
  const text = data.toString('utf8');
  const values = extname(path) === '.jsonl' ? text.split('\n').filter(Boolean) : [text];
  values.forEach((value, index) => list(JSON.parse(value), `${index}`));
  return [Buffer.from(lines.join(''))];
}

const kinds = {
  '.slots': container,
  '.meso': container,
  '.ply': (data) => textMesh(data, (line) => !line.includes('end_header'), /^comment provenance\+? /),
  '.obj': (data) => textMesh(data, (line) => line[0] === 0x23, /^# provenance\+? /),
  '.png': png,
  '.exr': exr,
  '.glb': glb,
  '.drc': drc,
  '.json': json,
  '.jsonl': json,
};

function write(pieces) {
  const file = openSync(out, 'w');
  for (const piece of pieces)
    for (let done = 0; done < piece.length;) done += writeSync(file, piece, done);
  closeSync(file);
}

const without = kinds[extname(path)];
if (!without) {
  console.error(`without-provenance: ${path}: of no kind that carries a provenance`);
  process.exit(1);
}
try {
  write(without(readFileSync(path)));
} catch (error) {
  console.error(`without-provenance: ${path}: ${error.message}`);
  process.exit(1);
}
