// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import { execFileSync, spawnSync } from 'node:child_process';
import { mkdtempSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

import { coarse, completed, data, drop, expect, hasData, program, samples, source, test } from './program';
import type { Page } from '@playwright/test';

test.use({ viewport: { width: 1024, height: 640 } });  // less to draw

/** Writes bad crowns, as the program's own tests have them. */
const writer = process.env['RHIZODONT_HOSTILE'] ?? join(source, 'build/tests/common/write_hostile_crown');

/** What the page says of a file: a tooth's facts or a sentence, and nothing else goes on. */
async function answer(page: Page, name: string, bytes: Buffer): Promise<{ sentence: string | null }> {
  await drop(page, [{ name, bytes }]);
  await expect(page.locator('#said:visible, #hint:visible').first(), name).toBeVisible({ timeout: 60_000 });
  await expect(page.locator('#progress'), name).toBeHidden({ timeout: 60_000 });
  if (!(await page.locator('#said').isVisible())) {
    await expect(page.locator('#panel dl, #panel table').first(), name).toBeVisible();
    return { sentence: null };
  }
  const sentence = (await page.locator('#said .words > span').textContent()) ?? '';
  expect(sentence.length, name).toBeGreaterThan(10);
  await page.getByRole('button', { name: 'Close' }).click();
  return { sentence };
}

test('what is no crown is refused in the words of the command line, and another crown goes on', async ({ page, url }) => {
  await page.goto(url);
  const crown = readFileSync(join(samples, 'crown_36.stl'));
  const folder = mkdtempSync(join(tmpdir(), 'rhizodont-web-'));
  const bad: [string, Buffer][] = [
    ['notes.txt', Buffer.from('hello')], ['empty.stl', Buffer.alloc(0)], ['cut.stl', crown.subarray(0, 5000)],
    ['flat.obj', Buffer.from('v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n')], ['nowhere.obj', Buffer.from('v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n')],
    ['corner.obj', Buffer.from('v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n')], ['points.ply', Buffer.from('ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n')],
    ['zeros.ply.gz', Buffer.from('1f8b0800000000000003', 'hex')],
  ];
  for (const [name, bytes] of bad) {
    const { sentence } = await answer(page, name, bytes);
    expect(sentence, name).not.toBeNull();
    writeFileSync(join(folder, name), bytes);
    const run = spawnSync(program, ['complete', join(folder, name), '-o', join(folder, 'tooth.ply'), '--e', String(coarse)], { encoding: 'utf8' });
    expect(run.status, name).toBe(3);
    expect(run.stderr, name).toContain((sentence ?? '').replace(/ \[\d+ places\]$/, ''));
  }
  await drop(page, [{ name: 'crown_36.stl', bytes: crown }]);
  await completed(page);
  await expect(page.locator('#said')).toBeHidden();
});

test('every bad crown of the tests gets a tooth or a sentence', async ({ page, url }) => {
  await page.goto(url);
  const folder = mkdtempSync(join(tmpdir(), 'rhizodont-web-'));
  const kinds = execFileSync(writer, { encoding: 'utf8' }).trim().split('\n');
  expect(kinds.length).toBeGreaterThan(20);
  let refused = 0;
  for (const kind of kinds) {
    const file = join(folder, 'crown_34.ply');
    execFileSync(writer, [join(samples, 'crown_34.ply'), kind, '1', '800', file]);
    refused += (await answer(page, 'crown_34.ply', readFileSync(file))).sentence === null ? 0 : 1;
  }
  expect(refused).toBeGreaterThan(5);
  expect(refused).toBeLessThan(kinds.length);
});

test('work is cancelled, after a reload too', async ({ page, url }) => {
  await page.goto(url);
  await page.click('[data-sample="crown_36.stl"]');
  await completed(page);
  const width = page.getByRole('spinbutton', { name: 'Mesh width e' });
  await width.fill('0.2');
  await width.press('Enter');
  await expect(page.locator('#progress')).toBeVisible();
  await page.getByRole('button', { name: 'Cancel' }).click();
  await expect(page.locator('#said')).toContainText('Cancelled');
  await expect(page.locator('#progress')).toBeHidden();
  await expect(page.locator('#facts')).toContainText('36');  // what was there is there still
  // a fine arch takes longer than a page to come back
  await page.route('**/api/v1/jobs', (route) => {
    const sent = route.request().postDataJSON() as { options: object };
    return route.continue({ postData: JSON.stringify({ ...sent, options: { ...sent.options, e_mm: 0.2 } }) });
  });
  await page.click('#another');
  await page.click('[data-sample="scan_lower.ply"]');
  await expect(page.locator('#stages li').first()).toBeVisible();
  await page.reload();
  await expect(page.locator('#progress')).toBeVisible();
  await page.getByRole('button', { name: 'Cancel' }).click();
  await expect(page.locator('#said')).toContainText('Cancelled');
  await expect(page.locator('#progress')).toBeHidden();
});

test('every faulty file gets a tooth or a sentence', async ({ page, url }) => {
  test.skip(!hasData, 'the data folder is not there');
  await page.goto(url);
  const folder = join(data, 'faults');
  const names = readdirSync(folder).filter((name) => /\.(stl|ply|obj|off|vtp|vtk|gz)$/.test(name)).sort();
  expect(names.length).toBeGreaterThan(50);
  const every = Number(process.env['RHIZODONT_EVERY_FAULT'] ?? '3');  // all of them: 1
  for (const name of names.filter((_, i) => i % every === 0)) await answer(page, name, readFileSync(join(folder, name)));
});

test('a program that is gone is said', async ({ page, url }) => {
  await page.goto(url);
  await expect(page.locator('[data-sample]').first()).toBeVisible();
  await page.route('**/api/**', (route) => route.abort());
  await page.click('[data-sample="crown_36.stl"]');
  await expect(page.locator('#said')).toContainText('rhizodont serve');
});

test('a format that does not hold the crown is not offered', async ({ page, url }) => {
  await page.goto(url);
  await drop(page, [{ name: 'crown_34.ply', bytes: readFileSync(join(samples, 'crown_34.ply')) }]);
  await completed(page);
  await expect(page.getByRole('link', { name: 'STL', exact: true })).toBeVisible();
  const folder = mkdtempSync(join(tmpdir(), 'rhizodont-web-'));
  execFileSync(writer, [join(samples, 'crown_34.ply'), 'none', '0', '800', join(folder, 'crown_34.obj')]);
  // more digits than a float has
  const text = readFileSync(join(folder, 'crown_34.obj'), 'utf8').replace(/^v (\S+)/gm, (_, x: string) => `v ${(Number(x) + 1e-9).toFixed(12)}`);
  await drop(page, [{ name: 'crown_34.obj', bytes: Buffer.from(text) }]);
  await completed(page);
  await expect(page.getByRole('button', { name: 'STL', exact: true })).toBeDisabled();
  await expect(page.getByRole('link', { name: 'PLY', exact: true })).toBeVisible();
});
