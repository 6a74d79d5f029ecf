// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import { existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';

import { AxeBuilder } from '@axe-core/playwright';

import { data, drawing, drop, expect, pictures, test } from './program';

const scan = process.env['RHIZODONT_SCAN'] ?? join(data, 'arches/scan_022_lower.ply');

test('a scan becomes an arch; labels are corrected; a measured length is taken', async ({ page, url }) => {
  test.skip(!existsSync(scan), 'the data folder is not there');
  test.setTimeout(600_000);
  await page.goto(url);
  await drop(page, [{ name: 'scan.ply', bytes: readFileSync(scan) }]);
  await expect(page.locator('#hint')).toContainText('Done in', { timeout: 300_000 });
  const rows = page.locator('tbody tr');
  const count = await rows.count();
  expect(count).toBeGreaterThan(3);
  await page.getByRole('combobox', { name: 'Colour' }).selectOption('clearance');
  await expect(page.locator('#legend')).toContainText('nearest other tooth');
  await drawing(page);
  await page.screenshot({ path: join(pictures, 'arch.png') });
  expect((await new AxeBuilder({ page }).analyze()).violations).toEqual([]);
  const before = await drawing(page);
  await page.getByRole('group', { name: 'Lower jaw' }).getByRole('button', { pressed: true }).nth(3).click();
  await expect.poll(async () => (await drawing(page)).equals(before)).toBe(false);
  // a number is given to the tooth in the middle of the view
  await page.getByRole('combobox', { name: 'Number' }).selectOption({ label: 'Tooth 31' });
  await page.getByRole('button', { name: 'Point at the tooth' }).click();
  await page.locator('#view').press('Enter');
  await expect(page.locator('.correct')).toContainText('31 placed', { timeout: 300_000 });
  await expect(page.locator('tbody th', { hasText: '31' })).toHaveCount(1);
  // a measured length
  const length = page.getByRole('spinbutton', { name: 'Tooth 31' });
  await length.fill('15.5');
  await page.getByRole('button', { name: 'Apply lengths' }).click();
  await expect(page.locator('tbody tr', { hasText: /^31/ }).locator('td').nth(1)).toHaveText(/^15\.[3-7]/, { timeout: 300_000 });
});
