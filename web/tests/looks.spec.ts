// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import { AxeBuilder } from '@axe-core/playwright';
import { join } from 'node:path';

import { completed, expect, openSample, overlaps, pictures, sizes, test } from './program';

for (const theme of ['light', 'dark'] as const)
  test(`axe finds nothing in ${theme}, nothing lies over anything`, async ({ page, url }) => {
    await page.emulateMedia({ colorScheme: theme });
    await page.goto(url);
    await expect(page.locator('[data-sample]').first()).toBeVisible();
    expect((await new AxeBuilder({ page }).analyze()).violations).toEqual([]);
    await page.screenshot({ path: join(pictures, `welcome-${theme}.png`) });
    await openSample(page, url, 'crown_36.stl');
    expect((await new AxeBuilder({ page }).analyze()).violations).toEqual([]);
    for (const [width, height] of theme === 'light' ? sizes : sizes.slice(0, 1)) {  // colours move nothing
      await page.setViewportSize({ width, height });
      await page.keyboard.press('g');
      await expect(page.locator('#hint')).toContainText('80 %');
      await page.keyboard.press('0');
      expect(await overlaps(page), `${width} x ${height}`).toEqual([]);
      await expect(page.locator('#notice')).toBeInViewport();
      await page.screenshot({ path: join(pictures, `tooth-${theme}-${width}.png`) });
      await page.keyboard.press('g');
    }
  });

test('German has its words everywhere', async ({ page, url }) => {
  await openSample(page, url, 'crown_36.stl');
  await page.getByRole('combobox', { name: 'Language' }).selectOption('de');
  await expect(page.locator('html')).toHaveAttribute('lang', 'de');
  await expect(page.locator('#notice')).toContainText('nicht die Anatomie des Patienten');
  await expect(page.locator('#facts')).toContainText('Krone exakt');
  for (const [width, height] of sizes) {
    await page.setViewportSize({ width, height });
    expect(await overlaps(page), `${width} x ${height}`).toEqual([]);
  }
  await page.screenshot({ path: join(pictures, 'tooth-german-1024.png') });
  expect((await new AxeBuilder({ page }).analyze()).violations).toEqual([]);
  await page.reload();
  await completed(page);
  await expect(page.locator('html')).toHaveAttribute('lang', 'de');
});
