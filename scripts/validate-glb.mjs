// Checks GLB files with the Khronos validator (npm package gltf-validator).
//
//     node scripts/validate-glb.mjs [--modules FOLDER] FILE...
//
// The package is looked for in FOLDER/node_modules, FOLDER itself, the folders
// of NODE_PATH, then as node does. Exit code 0: no error and no warning in any
// file; 1: some, printed one a line; 2: wrong usage, or no validator.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { delimiter, resolve } from 'node:path';

const files = process.argv.slice(2);
const folders = (process.env.NODE_PATH ?? '').split(delimiter).filter(Boolean);
if (files[0] === '--modules') {
  const folder = files.splice(0, 2)[1];
  if (folder !== undefined) folders.unshift(resolve(folder, 'node_modules'), folder);
}
if (files.length === 0) {
  console.error('usage: node validate-glb.mjs [--modules FOLDER] FILE...');
  process.exit(2);
}

function loadValidator() {
  const require = createRequire(import.meta.url);
  for (const folder of folders) {
    try {
      return require(resolve(folder, 'gltf-validator'));
    } catch (error) {
      if (error.code !== 'MODULE_NOT_FOUND') throw error;
    }
  }
  try {
    return require('gltf-validator');
  } catch {
    console.error('validate-glb: no gltf-validator: npm install gltf-validator, and give its folder with --modules');
    process.exit(2);
  }
}

const SEVERITIES = ['error', 'warning'];
const validator = loadValidator();
let bad = false;
for (const file of files) {
  try {
    const report = await validator.validateBytes(new Uint8Array(readFileSync(file)), { maxIssues: 1000 });
    for (const issue of report.issues.messages.filter((m) => m.severity < SEVERITIES.length)) {
      console.error(`${file}: ${SEVERITIES[issue.severity]}: ${issue.pointer ?? ''}: ${issue.message} [${issue.code}]`);
      bad = true;
    }
    bad ||= report.issues.truncated || report.issues.numErrors + report.issues.numWarnings > 0;
  } catch (error) {
    console.error(`${file}: error: ${error.message ?? error}`);
    bad = true;
  }
}
process.exit(bad ? 1 : 0);
