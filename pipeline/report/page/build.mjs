// Bundles the page's modules and styles into the one file that the program fills with data:
//   node build.mjs OUT.html      packages come from QUADRILLE_NODE_MODULES, or from node_modules beside this file
import { createRequire } from 'node:module';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { readFileSync, writeFileSync } from 'node:fs';

const here = dirname(fileURLToPath(import.meta.url));
const packages = process.env.QUADRILLE_NODE_MODULES ?? join(here, 'node_modules');
const { buildSync } = createRequire(join(packages, 'x.js'))('esbuild');

const built = buildSync({
  entryPoints: [join(here, 'src/main.js')],
  bundle: true,
  minify: true,
  write: false,
  outdir: '/',
  format: 'iife',
  target: ['es2021'],
  charset: 'utf8',
  legalComments: 'inline',
  nodePaths: [packages],
  logLevel: 'warning',
});
const output = (ending) => built.outputFiles.find((file) => file.path.endsWith(ending)).text;
// What stands in a script or a style ends at the first closing tag, whatever the language says of it.
const script = output('.js').replace(/<\/(script)/gi, '<\\/$1').replace(/<!--/g, '<\\!--');
const style = output('.css').replace(/<\/(style)/gi, '<\\/$1');
const page = readFileSync(join(here, 'page.html'), 'utf8')
  .replace('<!--style-->', () => `<style>${style}</style>`)
  .replace('<!--script-->', () => `<script>${script}</script>`);
writeFileSync(process.argv[2], page);
