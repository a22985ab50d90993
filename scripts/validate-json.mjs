// Checks JSON files against a JSON Schema (npm package ajv), and JSON lines (.jsonl) line by line.
//
//     node scripts/validate-json.mjs SCHEMA FILE...
//
// The package is looked for in the folders of NODE_PATH, then as node does.
// Exit code 0: all are valid; 1: some are not, printed one a line; 2: wrong usage, or no ajv.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { delimiter, resolve } from 'node:path';

const [schema, ...files] = process.argv.slice(2);
if (files.length === 0) {
  console.error('usage: node validate-json.mjs SCHEMA FILE...');
  process.exit(2);
}

function loadAjv() {
  const require = createRequire(import.meta.url);
  const folders = (process.env.NODE_PATH ?? '').split(delimiter).filter(Boolean);
  for (const name of [...folders.map((folder) => resolve(folder, 'ajv')), 'ajv']) {
    try {
      return require(name);
    } catch (error) {
      if (error.code !== 'MODULE_NOT_FOUND') throw error;
    }
  }
  console.error('validate-json: no ajv: npm install ajv, and give its folder in NODE_PATH');
  process.exit(2);
}

const Ajv = loadAjv();
const valid = new Ajv({ allErrors: true, strict: false }).compile(JSON.parse(readFileSync(schema)));
let bad = false;
for (const file of files) {
  const text = readFileSync(file, 'utf8');
  const values = file.endsWith('.jsonl') ? text.split('\n').filter(Boolean) : [text];
  values.forEach((value, index) => {
    if (valid(JSON.parse(value))) return;
    bad = true;
    for (const error of valid.errors) {
      console.error(`${file}${values.length > 1 ? `:${index + 1}` : ''}: ${error.instancePath}: ${error.message}`);
    }
  });
}
process.exit(bad ? 1 : 0);
