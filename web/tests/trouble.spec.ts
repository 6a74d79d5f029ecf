// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';

import { completed, data, drop, expect, hasData, samples, test } from './program';

test('what is no mesh is refused in words, and another crown goes on', async ({ page, url }) => {
  await page.goto(url);
  for (const [name, bytes] of [['notes.txt', Buffer.from('hello')], ['empty.stl', Buffer.alloc(0)], ['cut.stl', readFileSync(join(samples, 'crown_36.stl')).subarray(0, 5000)]] as const) {
    await drop(page, [{ name, bytes }]);
    await expect(page.locator('#said')).toBeVisible();
    await expect(page.locator('#said .words')).not.toBeEmpty();
    await expect(page.locator('#progress')).toBeHidden();
    await page.getByRole('button', { name: 'Close' }).click();
  }
  await drop(page, [{ name: 'crown_36.stl', bytes: readFileSync(join(samples, 'crown_36.stl')) }]);
  await completed(page);
  await expect(page.locator('#said')).toBeHidden();
});

test('work is cancelled', async ({ page, url }) => {
  await page.goto(url);
  await page.click('[data-sample="crown_36.stl"]');
  await completed(page);
  await page.getByRole('spinbutton', { name: 'Mesh width e' }).fill('0.2');
  await page.getByRole('spinbutton', { name: 'Mesh width e' }).press('Enter');
  await expect(page.locator('#progress')).toBeVisible();
  await page.getByRole('button', { name: 'Cancel' }).click();
  await expect(page.locator('#said')).toContainText('Cancelled');
  await expect(page.locator('#progress')).toBeHidden();
  await expect(page.locator('#facts')).toContainText('36');  // what was there is there still
});

test('every faulty input gets a tooth or a sentence', async ({ page, url }) => {
  test.skip(!hasData, 'the data folder is not there');
  test.setTimeout(600_000);
  await page.goto(url);
  const folder = join(data, 'faults');
  const names = readdirSync(folder).filter((name) => /\.(stl|ply|obj|off|vtp|vtk|gz)$/.test(name)).sort();
  expect(names.length).toBeGreaterThan(50);
  const every = Number(process.env['RHIZODONT_EVERY_FAULT'] ?? '6');  // all of them: 1
  for (const name of names.filter((_, i) => i % every === 0)) {
    const bytes = readFileSync(join(folder, name));
    if (bytes.length > 20_000_000) continue;
    await drop(page, [{ name, bytes }]);
    await expect(page.locator('#said:visible, #hint:visible').first(), name).toBeVisible({ timeout: 60_000 });
    await expect(page.locator('#progress'), name).toBeHidden({ timeout: 60_000 });
    const said = await page.locator('#said').isVisible();
    expect(said ? ((await page.locator('#said .words').textContent()) ?? '').length : 99, name).toBeGreaterThan(10);
  }
});

test('a program that is gone is said', async ({ page, url }) => {
  await page.goto(url);
  await expect(page.locator('[data-sample]').first()).toBeVisible();
  await page.route('**/api/**', (route) => route.abort());
  await page.click('[data-sample="crown_36.stl"]');
  await expect(page.locator('#said')).toContainText('rhizodont serve');
});
