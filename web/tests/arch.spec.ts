// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import { join } from 'node:path';

import { accessible, drawing, expect, pictures, redrawn, test } from './program';

test('a scan without labels becomes an arch; its teeth are corrected; a measured length is taken', async ({ page, url }) => {
  await page.goto(url);
  await page.click('[data-sample="scan_lower.ply"]');
  await expect(page.locator('#hint')).toContainText('Done in', { timeout: 150_000 });
  const rows = page.locator('tbody tr');
  expect(await rows.count()).toBeGreaterThan(11);
  await expect(page.locator('td.why')).toHaveCount(0);
  await expect(page.locator('tbody th').first()).toContainText(/\d %/);  // how sure its number is
  await page.getByRole('combobox', { name: 'Colour' }).selectOption('clearance');
  await expect(page.locator('#legend')).toContainText('nearest other tooth');
  let before = await drawing(page);
  await page.screenshot({ path: join(pictures, 'arch.png') });
  await accessible(page);
  await page.keyboard.press('u');
  before = await redrawn(page, before, 'without gum');
  const seventh = page.getByRole('group', { name: 'Lower jaw' }).getByRole('button', { disabled: false }).nth(6);
  await seventh.click();
  await expect(seventh).toHaveAttribute('aria-pressed', 'false');
  before = await redrawn(page, before, 'without a tooth');
  await seventh.click();
  await redrawn(page, before, 'and with it');
  // a tooth that is none, and what was found comes back
  const count = await rows.count();
  const last = (await page.locator('tbody th').last().textContent())?.slice(0, 2) ?? '';
  await page.getByRole('button', { name: `Tooth ${last}: mark as missing` }).click();
  await expect(page.locator('.correct .done')).toHaveText(`${last} missing`);
  await expect(rows).not.toHaveCount(0);
  await page.locator('.correct').getByRole('button', { name: 'Undo' }).click();
  await expect(page.locator('.correct .done')).toHaveCount(0);
  await expect(rows).toHaveCount(count);
  // a number is given to the tooth beside the middle of the view
  await page.getByRole('combobox', { name: 'Number' }).selectOption({ label: 'Tooth 31' });
  await page.getByRole('button', { name: 'Point at the tooth' }).click();
  await page.locator('#view').press('1');
  const box = await page.locator('#view').boundingBox();
  if (!box) throw new Error('no view');
  await page.mouse.click(box.x + box.width / 2 + 18, box.y + box.height / 2 - 44);
  await expect(page.locator('.correct')).toContainText('31 placed', { timeout: 60_000 });
  await expect(page.locator('tbody th', { hasText: '31' })).toHaveCount(1);
  // a measured length
  const length = page.getByRole('spinbutton', { name: 'Tooth 31' });
  await length.fill('15.5');
  await page.getByRole('button', { name: 'Apply lengths' }).click();
  await expect(page.locator('tbody tr', { hasText: /^31/ }).locator('td').nth(1)).toHaveText(/^15\.[2-8]/, { timeout: 60_000 });
});
