// Checks the types, then makes, in out/:
//   page.html         the page without data: one file, script and style inside
//   page.cpp          the same as a C++ source (validation/report_page.h)
//   unit.test.mjs     the unit tests, for node --test
//   e2e.mjs           the test in a browser
import { spawnSync } from 'node:child_process';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import process from 'node:process';
import { build } from 'esbuild';

const kPlaceholder = 'SIGNORINI_REPORT_JSON';
const kBytesPerChunk = 8000; // compilers need not take string literals longer than 65536

function checkTypes() {
  const compiler = 'node_modules/typescript/bin/tsc';
  const result = spawnSync(process.execPath, [compiler, '--project', '.'], { stdio: 'inherit' });
  if (result.status !== 0) process.exit(1);
}

async function bundled(entry, options) {
  const result = await build({
    entryPoints: [entry], bundle: true, write: false, charset: 'utf8', logLevel: 'warning',
    ...options,
  });
  return result.outputFiles[0].text;
}

/** Replaces a marker that stands in the text exactly once. */
function filled(text, marker, content) {
  const parts = text.split(marker);
  if (parts.length !== 2) throw new Error(`${marker}: found ${parts.length - 1} times, not once`);
  return parts.join(content);
}

async function makePage() {
  const browser = { minify: true, target: 'es2020', legalComments: 'none' };
  const script = await bundled('src/main.ts', { ...browser, format: 'iife' });
  const style = await bundled('src/style.css', browser);
  let page = readFileSync('src/page.html', 'utf8');
  page = filled(page, 'UPLOT_LICENSE', readFileSync('node_modules/uplot/LICENSE', 'utf8').trim());
  page = filled(page, 'THREE_LICENSE', readFileSync('node_modules/three/LICENSE', 'utf8').trim());
  page = filled(page, '/*STYLE*/', style.trim());
  page = filled(page, '/*SCRIPT*/', script.trim());
  filled(page, kPlaceholder, '');
  return page;
}

/** Bytes as the inside of a C++ string literal. Octal escapes end after three digits. */
function escaped(bytes) {
  let text = '';
  for (const byte of bytes) {
    const plain = byte >= 32 && byte < 127 && !'"\\?'.includes(String.fromCharCode(byte));
    text += plain ? String.fromCharCode(byte) : '\\' + byte.toString(8).padStart(3, '0');
  }
  return text;
}

function asSource(page) {
  const bytes = Buffer.from(page, 'utf8');
  const chunks = [];
  for (let at = 0; at < bytes.length; at += kBytesPerChunk) {
    const chunk = bytes.subarray(at, at + kBytesPerChunk);
    chunks.push(`    {"${escaped(chunk)}", ${chunk.length}},\n`);
  }
  return `// Made by validation/report/build.mjs.
#include <signorini/validation/report_page.h>

namespace signorini::validation {
namespace {

constexpr std::string_view kChunks[] = {
${chunks.join('')}};

std::string joined() {
  std::string text;
  for (const std::string_view chunk : kChunks) text += chunk;
  return text;
}

}  // namespace

std::string_view report_page_template() {
  static const std::string page = joined();
  return page;
}

std::string_view report_page_absent_because() { return {}; }

}  // namespace signorini::validation
`;
}

checkTypes();
const node = { platform: 'node', format: 'esm', target: 'node18' };
mkdirSync('out', { recursive: true });
writeFileSync('out/unit.test.mjs', await bundled('tests/all.test.ts', node));
writeFileSync('out/e2e.mjs', await bundled('tests/e2e.ts', { ...node, packages: 'external' }));
const page = await makePage();
writeFileSync('out/page.html', page);
writeFileSync('out/page.cpp', asSource(page));
