// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';

import { expect, test } from '@playwright/test';

import { source } from './program';

const web = join(source, 'web');
const read = (name: string): Record<string, string> => JSON.parse(readFileSync(join(web, 'src/texts', name), 'utf8')) as Record<string, string>;

test('each language has every text, with the same values in it', () => {
  const [en, de] = [read('en.json'), read('de.json')];
  expect(Object.keys(de).sort()).toEqual(Object.keys(en).sort());
  const values = (words: string): string[] => [...words.matchAll(/\{\w+\}/g)].map(([value]) => value).sort();
  for (const [key, words] of Object.entries(en)) {
    expect(words.trim(), key).not.toBe('');
    expect((de[key] ?? '').trim(), key).not.toBe('');
    expect(values(de[key] ?? ''), key).toEqual(values(words));
  }
});

test('there is no text that nothing says', () => {
  const files = [...readdirSync(join(web, 'src')).filter((name) => name.endsWith('.ts')).map((name) => join(web, 'src', name)),
                 ...readdirSync(join(web, 'parts')).map((name) => join(web, 'parts', name)), join(web, 'index.html'), join(web, 'report.html')];
  const sources = files.map((name) => readFileSync(name, 'utf8')).join('\n');
  // names that are put together: `view.${side}`, 'stage.' + name
  const beginnings = [...sources.matchAll(/`([\w.]+\.)\$\{|'(\w+\.)' \+/g)].map((found) => found[1] ?? found[2] ?? '');
  const unsaid = Object.keys(read('en.json')).filter((key) =>
    !sources.includes(`'${key}'`) && !sources.includes(`"${key}"`) && !beginnings.some((beginning) => key.startsWith(beginning)));
  expect(unsaid).toEqual([]);
});
