// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import { join } from 'node:path';

import { accessible, completed, expect, openSample, overlaps, pictures, sizes, test } from './program';

test('axe finds nothing in light and dark, nothing lies over anything', async ({ page, url }) => {
  await page.goto(url);
  await expect(page.locator('[data-sample]').first()).toBeVisible();
  await accessible(page);
  for (const [width, height] of sizes) {
    await page.setViewportSize({ width, height });
    expect(await overlaps(page), `${width} x ${height}`).toEqual([]);
    await page.screenshot({ path: join(pictures, `welcome-${width}.png`) });
  }
  await openSample(page, url, 'crown_36.stl');
  await accessible(page);
  await page.keyboard.press('g');
  await expect(page.locator('#hint')).toContainText('80 %');
  for (const theme of ['light', 'dark'] as const) {
    await page.emulateMedia({ colorScheme: theme });
    for (const [width, height] of sizes) {
      await page.setViewportSize({ width, height });
      await page.keyboard.press('0');
      expect(await overlaps(page), `${width} x ${height}`).toEqual([]);
      await expect(page.locator('#notice')).toBeInViewport();
      await page.screenshot({ path: join(pictures, `tooth-${theme}-${width}.png`) });
    }
  }
});

test('the theme is chosen by its button, and kept', async ({ page, url }) => {
  await page.goto(url);
  await expect(page.locator('html')).toHaveAttribute('data-theme', 'light');
  await page.getByRole('button', { name: 'Light or dark' }).click();
  await expect(page.locator('html')).toHaveAttribute('data-theme', 'dark');
  await page.reload();
  await expect(page.locator('html')).toHaveAttribute('data-theme', 'dark');
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
  await accessible(page, ['light']);
  await page.reload();
  await completed(page);
  await expect(page.locator('html')).toHaveAttribute('lang', 'de');
});
