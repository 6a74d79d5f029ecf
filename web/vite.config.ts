// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import { readFileSync } from 'node:fs';

import { defineConfig, type Plugin } from 'vite';

/** Puts what the page and the reports have in common (parts/) into either. */
const parts: Plugin = {
  name: 'parts',
  transformIndexHtml: {
    order: 'pre',
    handler: (html) => html.replace(/ *<!--part (\w+)-->\n/g, (_, name: string) =>
      readFileSync(new URL(`parts/${name}.html`, import.meta.url), 'utf8').replace(/^<!--.*?-->\n/s, '')),
  },
};

/** Puts script and styles into the page, which then opens from a disk without anything beside it. */
const inOneFile: Plugin = {
  name: 'in-one-file',
  enforce: 'post',
  generateBundle(_, bundle) {
    const page = bundle['report.html'];
    if (page?.type !== 'asset') throw new Error('there is no report.html');
    let html = String(page.source);
    for (const [name, file] of Object.entries(bundle)) {
      if (file === page) continue;
      const content = file.type === 'chunk' ? file.code : String(file.source);
      const tag = file.type === 'chunk' ? 'script' : 'style';
      html = html.replace(new RegExp(`\\s*<(script|link)[^>]*${name.replace('.', '\\.')}[^>]*>(</script>)?`), '');
      // at the end, after the data that the script reads
      const placed = `<${tag}${tag === 'script' ? ' type="module"' : ''}>${content.replaceAll('</script', '<\\/script')}</${tag}>\n`;
      html = tag === 'script' ? html.replace('</body>', () => placed + '</body>') : html.replace('</head>', () => placed + '</head>');
      delete bundle[name];
    }
    page.source = html;
  },
};

// One script and one style sheet with fixed names, which the build takes into the program; with --mode report the page of
// a report, in one file. `npm run dev` serves the page with a program that runs beside it.
export default defineConfig(({ mode }) => ({
  plugins: mode === 'report' ? [parts, inOneFile] : [parts],
  build: {
    target: 'es2022',
    modulePreload: false,
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 1200,
    emptyOutDir: mode !== 'report',
    rollupOptions: {
      input: mode === 'report' ? 'report.html' : 'index.html',
      output: { entryFileNames: 'app.js', assetFileNames: 'app[extname]', inlineDynamicImports: true },
    },
  },
  server: { proxy: { '/api': { target: 'http://127.0.0.1:8080', changeOrigin: true, headers: { origin: 'http://127.0.0.1:8080' } } } },
}));
