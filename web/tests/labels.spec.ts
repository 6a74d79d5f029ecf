// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

import { accessible, coarse, drawing, drop, expect, pictures, program, redrawn, test, twoMolars } from './program';
import type { Page } from '@playwright/test';

const teeth = async (page: Page): Promise<string[]> => page.locator('tbody th').allTextContents();
const shows = (page: Page, ...numbers: string[]): Promise<void> => expect.poll(() => teeth(page), { timeout: 60_000 }).toEqual(numbers);

test('labels that were given are corrected, and a measured length moves the others', async ({ page, url }) => {
  const { scan, labels } = twoMolars();
  await page.goto(url);
  await drop(page, [{ name: 'scan.obj', bytes: scan }, { name: 'scan.json', bytes: labels }]);
  await shows(page, '36');
  await expect(page.locator('td.why')).toContainText('no root');  // for it is two
  // divided where the two meet
  await page.getByRole('combobox', { name: 'Number' }).selectOption({ label: 'Tooth 37' });
  await page.getByRole('button', { name: 'Divide at a point' }).click();
  await page.locator('#view').press('5');
  await page.locator('#view').press('Enter');
  await shows(page, '36', '37');
  await expect(page.locator('.correct .done')).toHaveText('37 divided off');
  await expect(page.locator('td.why')).toHaveCount(0);
  await page.screenshot({ path: join(pictures, 'labels.png') });
  await accessible(page, ['dark', 'light']);
  // what one sees of two teeth alone
  let drawn = await drawing(page);
  await page.getByRole('combobox', { name: 'Colour' }).selectOption('clearance');
  await expect(page.locator('#legend')).toContainText('nearest other tooth');
  drawn = await redrawn(page, drawn, 'clearance');
  const chart = page.getByRole('group', { name: 'Lower jaw' }).getByRole('button', { name: 'Tooth 37' });
  await chart.click();
  await expect(chart).toHaveAttribute('aria-pressed', 'false');
  drawn = await redrawn(page, drawn, 'a tooth hidden');
  await chart.click();
  await redrawn(page, drawn, 'and shown');
  // one measured length moves the other
  const root = (row: number): Promise<number> => page.locator('tbody tr').nth(row).locator('td').nth(1).textContent().then(Number);
  const before = [await root(0), await root(1)] as const;
  await page.getByRole('spinbutton', { name: 'Tooth 36' }).fill(String(Math.round(before[0]) + 3));
  await page.getByRole('button', { name: 'Apply lengths' }).click();
  await expect.poll(() => root(0), { timeout: 60_000 }).toBeGreaterThan(before[0] + 2);
  expect(await root(1)).toBeGreaterThan(before[1] + 0.15);
  // another number
  await page.getByRole('combobox', { name: 'Number' }).selectOption({ label: 'Tooth 35' });
  await page.getByRole('button', { name: 'Point at the tooth' }).click();
  const box = await page.locator('#view').boundingBox();
  if (!box) throw new Error('no view');
  await page.mouse.click(box.x + box.width * 0.4, box.y + box.height / 2);
  await expect(page.locator('.correct .done')).toContainText('35 placed', { timeout: 60_000 });
  expect(await teeth(page)).toContain('35');
  // undone; then merged, and marked as missing
  await page.locator('.correct').getByRole('button', { name: 'Undo' }).click();
  await shows(page, '36', '37');
  await page.getByRole('button', { name: 'Tooth 37: mark as missing' }).click();
  await shows(page, '36');
  await page.locator('.correct').getByRole('button', { name: 'Undo' }).click();
  await shows(page, '36', '37');
  await page.getByRole('button', { name: 'Merge' }).click();
  await shows(page, '36');
  await expect(page.locator('td.why')).toContainText('no root');
});

test('a correction that cannot be is refused, and what was there stays', async ({ page, url }) => {
  const { scan, labels } = twoMolars();
  await page.goto(url);
  await drop(page, [{ name: 'scan.obj', bytes: scan }, { name: 'scan.json', bytes: labels }]);
  await shows(page, '36');
  await page.getByRole('combobox', { name: 'Number' }).selectOption({ label: 'Tooth 36' });
  await page.getByRole('button', { name: 'Divide at a point' }).click();
  await page.locator('#view').press('5');
  await page.locator('#view').press('Enter');
  await expect(page.locator('#said')).toContainText('there is one already');
  await shows(page, '36');
});

test('an arch is, to the byte, what the command line makes of it', async ({ page, url }) => {
  const { scan, labels } = twoMolars(true);
  await page.goto(url);
  await drop(page, [{ name: 'scan.obj', bytes: scan }, { name: 'scan.json', bytes: labels }]);
  await shows(page, '36', '37');
  const folder = mkdtempSync(join(tmpdir(), 'rhizodont-web-'));
  writeFileSync(join(folder, 'scan.obj'), scan);
  writeFileSync(join(folder, 'labels.json'), labels);
  execFileSync(program, ['arch', join(folder, 'scan.obj'), '--labels', join(folder, 'labels.json'), '-o', join(folder, 'own'), '--e', String(coarse), '--quiet']);
  const download = async (name: string): Promise<string> => {
    const [file] = await Promise.all([page.waitForEvent('download'), page.getByRole('link', { name, exact: true }).click()]);
    return file.path();
  };
  for (const [name, file] of [['PLY', 'arch.ply'], ['GLB', 'arch.glb'], ['Report (JSON)', 'arch.json']] as const)
    expect(readFileSync(await download(name)).equals(readFileSync(join(folder, 'own', file))), file).toBe(true);
  for (const name of ['STL', 'OBJ']) expect(readFileSync(await download(name)).length, name).toBeGreaterThan(10_000);
  execFileSync('/usr/bin/python3', ['-m', 'zipfile', '-e', await download('All as ZIP'), join(folder, 'all')]);
  for (const file of ['tooth_36.ply', 'tooth_37.ply', 'crown_36.ply', 'labels.json'])
    expect(readFileSync(join(folder, 'all', file)).equals(readFileSync(join(folder, 'own', file))), file).toBe(true);
});
