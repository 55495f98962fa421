// Builds console/dist. Same sources and package-lock.json, same bytes: `.ci/run console` compares them.
import { build } from 'esbuild';
import { copyFileSync, readFileSync, writeFileSync } from 'node:fs';

const out = process.argv[2] ?? 'dist';
const common = {
  bundle: true, minify: true, charset: 'utf8', target: 'es2020', legalComments: 'none', logLevel: 'warning',
  jsx: 'automatic', jsxImportSource: 'preact', outdir: out,
};
await build({ ...common, entryPoints: { app: 'src/main.jsx', worker: 'src/worker.js' }, format: 'iife' });
// The bundle carries the licences of what is in it.
const licence = (name) => {
  const { version } = JSON.parse(readFileSync(`node_modules/${name}/package.json`));
  return `${name} ${version}\n\n${readFileSync(`node_modules/${name}/LICENSE`, 'utf8').trim()}`;
};
const text = `/*! ${['preact', 'uplot'].map(licence).join('\n\n')}\n*/\n`;
writeFileSync(`${out}/app.js`, text + readFileSync(`${out}/app.js`, 'utf8'));
for (const file of ['index.html', 'icon.svg']) copyFileSync(`src/${file}`, `${out}/${file}`);
