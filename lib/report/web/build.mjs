// Builds the page of the HTML report: node build.mjs [OUT.html], by default dist/report_page.html.
// The result depends on the sources and the pinned packages alone.
import { createHash } from 'node:crypto';
import { mkdir, readFile, writeFile } from 'node:fs/promises';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';

const here = dirname(fileURLToPath(import.meta.url));
const out = process.argv[2] ?? join(here, 'dist', 'report_page.html');

async function bundle() {
  const result = await build({
    absWorkingDir: here,
    entryPoints: { page: 'src/main.ts' },
    outdir: 'unused',
    bundle: true,
    write: false,
    minify: true,
    charset: 'utf8',
    format: 'iife',
    target: ['chrome100', 'firefox113', 'safari16.4'],
    legalComments: 'none', // the licenses stand whole in the page
  });
  const text = (end) => result.outputFiles.find((file) => file.path.endsWith(end)).text.trim();
  return { script: text('.js'), style: text('.css') };
}

async function licenses() {
  const texts = await Promise.all(
    ['three', 'uplot'].map(async (name) => {
      const folder = join(here, 'node_modules', name);
      const { version } = JSON.parse(await readFile(join(folder, 'package.json'), 'utf8'));
      const license = (await readFile(join(folder, 'LICENSE'), 'utf8')).replaceAll('\r\n', '\n').trim();
      return `${name} ${version}\n\n${license}`;
    }),
  );
  return `This page contains:\n\n${texts.join('\n\n')}\n`;
}

const sha256 = (text) => `'sha256-${createHash('sha256').update(text).digest('base64')}'`;

/** Only this very script and style may run, and nothing may be fetched. */
function policy({ script, style }) {
  return [
    "default-src 'none'",
    `script-src ${sha256(script)}`,
    `style-src ${sha256(style)}`,
    'img-src blob: data:',
    "base-uri 'none'",
    "form-action 'none'",
  ].join('; ');
}

/** What would end its element early, or could load something from elsewhere. */
function check(page, { script, style }, comment) {
  const faults = [
    [/<!--|<script|<\/script/i.test(script), 'the script holds markup that would end it'],
    [/<\/style/i.test(style), 'the style holds markup that would end it'],
    [comment.includes('-->'), 'a license would end its comment'],
    [/@import|url\((?!["']?data:)/.test(style), 'the style refers to another file'],
    [/\b(?:src|href)="/.test(page), 'the page refers to another file'],
    [page.split('<!--CMAP_DATA-->').length !== 2, 'the page needs exactly one <!--CMAP_DATA-->'],
  ];
  const fault = faults.find(([wrong]) => wrong);
  if (fault) throw new Error(fault[1]);
}

const code = await bundle();
const comment = await licenses();
const source = await readFile(join(here, 'src', 'page.html'), 'utf8');
const parts = { LICENSES: comment, POLICY: policy(code), STYLE: code.style, SCRIPT: code.script };
check(source, code, comment);
const page = source.replace(/@(LICENSES|POLICY|STYLE|SCRIPT)@/g, (_, name) => parts[name]);
await mkdir(dirname(out), { recursive: true });
await writeFile(out, page);
console.log(`${out}: ${page.length} characters, script ${code.script.length}, style ${code.style.length}`);
