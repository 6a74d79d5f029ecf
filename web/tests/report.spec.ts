// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import { execFileSync, spawnSync } from 'node:child_process';
import { copyFileSync, mkdirSync, mkdtempSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

import { accessible, coarse, drawing, expect, overlaps, pictures, program, redrawn, samples, sizes, test } from './program';

test('a report opens by itself, without a server', async ({ page }) => {
  const folder = mkdtempSync(join(tmpdir(), 'rhizodont-report-'));
  const report = join(folder, 'report.html');
  execFileSync(program, ['complete', join(samples, 'crown_36.stl'), '-o', join(folder, 'tooth.ply'), '--e', String(coarse), '--report', report, '--quiet']);
  await page.goto('file://' + report);
  await expect(page.locator('#panel')).toContainText('crown exact, closed solid');
  await expect(page.locator('#panel')).toContainText(/[0-9a-f]{64}/);
  await expect(page.locator('#notice')).toBeInViewport();
  const before = await drawing(page);
  await page.getByRole('combobox', { name: 'Colour' }).selectOption('uncertainty');
  await redrawn(page, before, 'another view');
  await page.screenshot({ path: join(pictures, 'report.png') });
  await page.getByRole('combobox', { name: 'Language' }).selectOption('de');
  await expect(page.locator('#panel')).toContainText('Krone exakt');
  await accessible(page);
});

test('the report on a crown without a tooth says why', async ({ page }) => {
  const folder = mkdtempSync(join(tmpdir(), 'rhizodont-report-'));
  const crown = join(folder, 'flat.obj');
  writeFileSync(crown, 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n');
  const report = join(folder, 'report.html');
  const run = spawnSync(program, ['complete', crown, '--fdi', '36', '-o', join(folder, 'tooth.ply'), '--report', report]);
  expect(run.status).toBe(3);
  await page.goto('file://' + report);
  await expect(page.locator('.refused')).not.toBeEmpty();
});

test('the report on an arch shows its teeth, one by one and all together', async ({ page }) => {
  const folder = mkdtempSync(join(tmpdir(), 'rhizodont-report-'));
  const crowns = join(folder, 'crowns');
  mkdirSync(crowns);
  copyFileSync(join(samples, 'crown_34.ply'), join(crowns, 'crown_34.ply'));
  copyFileSync(join(samples, 'crown_36.stl'), join(crowns, 'crown_75.stl'));  // a milk tooth's number: refused
  const report = join(folder, 'arch.html');
  const run = spawnSync(program, ['arch', crowns, '-o', join(folder, 'out'), '--e', String(coarse), '--report', report, '--quiet']);
  expect(run.status).toBe(6);
  await page.goto('file://' + report);
  await expect(page.locator('#panel')).toContainText('1 of 2');
  await expect(page.locator('td.why')).toContainText('milk tooth');
  await expect(page.locator('#panel')).toContainText('completion.safetensors');
  const before = await drawing(page);
  await page.getByRole('button', { name: 'Tooth 34' }).click();
  await redrawn(page, before, 'another view');
  await page.getByRole('combobox', { name: 'Colour' }).selectOption('quality');
  for (const [width, height] of sizes) {
    await page.setViewportSize({ width, height });
    expect(await overlaps(page), `${width} x ${height}`).toEqual([]);
  }
  await page.screenshot({ path: join(pictures, 'report-arch.png') });
  await accessible(page);
});

test('the report on an evaluation has its tables, its plot and where they come from', async ({ page }) => {
  const folder = mkdtempSync(join(tmpdir(), 'rhizodont-report-'));
  const cases = join(folder, 'cases');
  mkdirSync(cases);
  copyFileSync(join(samples, 'crown_36.stl'), join(cases, 'crown_36.stl'));
  execFileSync(program, ['complete', join(samples, 'crown_36.stl'), '--fdi', '36', '--root-length', '14', '--e', String(coarse), '-o', join(cases, 'tooth_36.ply'), '--quiet']);
  const report = join(folder, 'evaluation.html');
  execFileSync(program, ['evaluate', cases, '--report', report]);
  await page.goto('file://' + report);
  await expect(page.getByRole('img', { name: 'Predicted against true root lengths' })).toBeVisible();
  await expect(page.locator('#stage tbody tr')).toHaveCount(1);
  await expect(page.locator('#panel')).toContainText(/[0-9a-f]{64}/);
  await expect(page.locator('#panel')).toContainText('completion.safetensors');
  for (const [width, height] of sizes) {
    await page.setViewportSize({ width, height });
    expect(await overlaps(page), `${width} x ${height}`).toEqual([]);
  }
  await page.screenshot({ path: join(pictures, 'report-evaluation.png') });
  await page.getByRole('combobox', { name: 'Language' }).selectOption('de');
  await expect(page.locator('#panel')).toContainText('Mittelwerte');
  await accessible(page);
});
