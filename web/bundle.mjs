// node bundle.mjs OUT_DIR: bundles the charts and the page's script, with the licences of what is in them, and writes them as
// C++ (web/bundle.h). Run from the folder that has node_modules.
import { createHash } from 'node:crypto';
import { mkdirSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { createRequire } from 'node:module';

const here = dirname(fileURLToPath(import.meta.url));
const packages = resolve('node_modules');
const { build } = createRequire(join(packages, 'x.js'))('esbuild');
const out = resolve(process.argv[2]);

async function bundled(entry, options) {
  const result = await build({
    entryPoints: [join(here, entry)], bundle: true, write: false, metafile: true, charset: 'utf8', legalComments: 'none', nodePaths: [packages],
    minifyWhitespace: true, minifyIdentifiers: true, absWorkingDir: here, logLevel: 'warning', ...options,
  });
  const names = Object.keys(result.metafile.inputs).map((path) => /node_modules\/((?:@[^/]+\/)?[^/]+)\//.exec(path)?.[1]);
  return { text: result.outputFiles[0].text, packages: [...new Set(names.filter(Boolean))].sort() };
}

// Licences and notices of a package, also those of what it contains of others.
function licenceOf(name) {
  const folder = join(packages, name);
  const { version } = JSON.parse(readFileSync(join(folder, 'package.json'), 'utf8'));
  const files = readdirSync(folder).filter((file) => /^(licen[sc]e|notice|copying)/i.test(file) && !/s$/i.test(file.replace(/\..*/, ''))).sort().map((file) => join(folder, file));
  const others = readdirSync(folder, { withFileTypes: true }).filter((entry) => entry.isDirectory() && /^licenses?$/i.test(entry.name))
    .flatMap((entry) => readdirSync(join(folder, entry.name)).sort().map((file) => join(folder, entry.name, file)));
  return `${name} ${version}\n\n${[...files, ...others].map((file) => readFileSync(file, 'utf8').trim()).join('\n\n')}\n`;
}

// A C++ string literal; the compiler reads pieces of 16 kB.
function literal(text) {
  const pieces = [];
  for (let at = 0; at < text.length; at += 16000) pieces.push(`R"~~web~~(${text.slice(at, at + 16000)})~~web~~"`);
  return pieces.join('\n') || '""';
}

// Duktape has neither arrow functions nor const; esbuild's other shortenings use syntax that it doesn't read.
const charts = await bundled('charts/charts.js', { target: 'es5', format: 'iife', globalName: 'elbowroomCharts', define: { global: 'globalThis' } });
const page = await bundled('page/report.js', { target: 'es2020', format: 'iife', minifySyntax: true, define: { global: 'globalThis' } });
const licences = [...new Set([...charts.packages, ...page.packages])].map(licenceOf).join(`\n${'-'.repeat(80)}\n\n`);
// A compiler reads each end of line as one character, and so does a browser: the hash is of those.
const script = `/* Contains the packages below, under their licences.\n\n${licences.replaceAll('*/', '* /')}*/\n${page.text}`.replaceAll(/\r\n?/g, '\n');
if (/<\/script|<!--/i.test(script)) throw new Error('the script would end within a page');
const hash = createHash('sha256').update(script, 'utf8').digest('base64');

mkdirSync(out, { recursive: true });
writeFileSync(join(out, 'charts.js'), charts.text);
writeFileSync(join(out, 'report.js'), script);
writeFileSync(join(out, 'licences_of_scripts.txt'), licences);
writeFileSync(join(out, 'bundle_text.cc'), `// Written by web/bundle.mjs.
#include "web/bundle.h"

namespace elbowroom::web {

std::string_view ChartScript() { return ${literal(charts.text)}; }
std::string_view ReportScript() { return ${literal(script)}; }
std::string_view ReportScriptSha256() { return "${hash}"; }

}  // namespace elbowroom::web
`);
