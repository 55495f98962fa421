// Writes manifests (YAML on standard input) as TypeScript whose literals have the types of the Kubernetes API: the
// compiler then finds wrong types and also misspelt fields, which a server would ignore.
import yaml from 'js-yaml';
import { readFileSync } from 'node:fs';

const lines = [];
yaml.loadAll(readFileSync(0, 'utf8'), manifest => {
  const { apiVersion, kind, metadata } = manifest;
  const folder = apiVersion.includes('/') ? apiVersion : `${apiVersion}`;
  const name = `I${kind}`;
  const number = lines.length;
  lines.push(`// ${kind} ${metadata.name}
import type { ${name} as T${number} } from 'kubernetes-models/${folder}/${kind}';
export const m${number}: T${number} = ${JSON.stringify(manifest, null, 1)};`);
});
if (lines.length === 0) throw new Error('no manifest');
console.log(lines.join('\n'));
