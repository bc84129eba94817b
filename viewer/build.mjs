// Builds dist/viewer.js, the script that the program carries, from src/ and three.js. `--check` compares it with what is there instead.
import { build } from 'esbuild';
import { readFile, writeFile } from 'node:fs/promises';

const out = new URL('dist/viewer.js', import.meta.url);
const made = await build({
  absWorkingDir: new URL('.', import.meta.url).pathname,
  entryPoints: ['src/main.js'],
  bundle: true,
  minify: true,
  format: 'esm',
  target: 'es2022',
  charset: 'utf8',
  legalComments: 'none',
  banner: { js: '/* Pseudopod (MIT OR Apache-2.0) with three.js, Copyright © 2010-2026 three.js authors (MIT, https://threejs.org/license). Built from viewer/src: do not edit. */' },
  write: false,
});
const [{ contents }] = made.outputFiles;
if (process.argv.includes('--check')) {
  const there = await readFile(out);
  if (!there.equals(contents)) {
    console.error('viewer/dist/viewer.js is not what viewer/src makes: run viewer/build and commit it');
    process.exit(1);
  }
  console.log(`viewer/dist/viewer.js is what viewer/src makes (${contents.length} bytes)`);
} else {
  await writeFile(out, contents);
  console.log(`viewer/dist/viewer.js: ${contents.length} bytes`);
}
