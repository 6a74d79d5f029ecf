// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

import { completed, drawing, drop, expect, openSample, program, samples, test } from './program';

test('a crown that is dropped becomes a tooth, its stages shown as they happen', async ({ page, url }) => {
  await openSample(page, url, 'crown_34.ply');  // the program and the browser are warm then
  await page.click('#another');
  await page.evaluate(() => {
    const seen: string[] = [];
    new MutationObserver(() => {
      for (const item of document.querySelectorAll('#stages li'))
        if (!seen.includes(item.textContent ?? '')) seen.push(item.textContent ?? '');
      document.body.dataset['seen'] = seen.join(',');
    }).observe(document.getElementById('stages') as HTMLElement, { childList: true, subtree: true });
  });
  const begun = Date.now();
  await drop(page, [{ name: 'crown_36.stl', bytes: readFileSync(join(samples, 'crown_36.stl')) }]);
  await completed(page);
  const seconds = (Date.now() - begun) / 1000;
  console.log(`first result ${seconds.toFixed(2)} s after the drop`);
  const seen = (await page.evaluate(() => document.body.dataset['seen'])) ?? '';
  for (const stage of ['crown', 'completion network', 'guiding surface', 'joining', 'proof']) expect(seen).toContain(stage);
  await expect(page.locator('#facts')).toContainText('crown exact, closed solid');
  await expect(page.getByRole('button', { name: 'Tooth 36' })).toHaveAttribute('aria-current', 'true');
  await expect(page.locator('#notice')).toBeInViewport();
});

test('files are, to the byte, those of the command line', async ({ page, url }) => {
  await openSample(page, url, 'crown_36.stl');
  const folder = mkdtempSync(join(tmpdir(), 'rhizodont-web-'));
  for (const ending of ['ply', 'stl', 'obj', 'glb']) {
    const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('link', { name: ending.toUpperCase(), exact: true }).click()]);
    expect(download.suggestedFilename()).toBe(`tooth_36.${ending}`);
    const own = join(folder, `tooth.${ending}`);
    execFileSync(program, ['complete', join(samples, 'crown_36.stl'), '-o', own, '--quiet']);
    expect(readFileSync(await download.path()).equals(readFileSync(own)), ending).toBe(true);
  }
  const [report] = await Promise.all([page.waitForEvent('download'), page.getByRole('link', { name: 'Report (JSON)' }).click()]);
  expect(JSON.parse(readFileSync(await report.path(), 'utf8'))).toHaveProperty('report_version', 3);
  const [all] = await Promise.all([page.waitForEvent('download'), page.getByRole('link', { name: 'All as ZIP' }).click()]);
  expect(readFileSync(await all.path()).subarray(0, 2).toString()).toBe('PK');
});

test('a root is lengthened, undone and reset', async ({ page, url }) => {
  await openSample(page, url, 'crown_36.stl');
  const length = page.getByRole('spinbutton', { name: 'Length, mm' });
  const first = await length.inputValue();
  const before = await drawing(page);
  const answered = page.waitForResponse((response) => response.url().includes('/views/crown'));
  const begun = Date.now();
  await length.fill('18.5');
  await length.press('Enter');
  await answered;
  console.log(`a root answers after ${Date.now() - begun} ms`);
  await expect(page.locator('#facts')).toContainText('set by you');
  await expect(page.locator('#facts')).toContainText('18.');
  await expect.poll(async () => (await drawing(page)).equals(before)).toBe(false);
  await page.getByRole('slider', { name: 'Tip' }).focus();
  await page.keyboard.press('ArrowRight');
  await expect(page.getByRole('slider', { name: 'Tip' })).toBeFocused();
  await expect(page.getByRole('spinbutton', { name: 'Tip' })).toHaveValue('1');
  await page.keyboard.press('Control+z');
  await expect(page.getByRole('spinbutton', { name: 'Tip' })).toHaveValue('0');
  await page.getByRole('button', { name: 'Reset' }).click();
  await expect(page.locator('#facts')).not.toContainText('set by you');
  await expect(length).toHaveValue(first);
  await expect.poll(async () => (await drawing(page)).equals(before)).toBe(true);
});

test('every colour is shown with its legend', async ({ page, url }) => {
  await openSample(page, url, 'skirt_36.ply');
  await page.getByRole('combobox', { name: 'Gum around the crown' }).selectOption('drop');
  await completed(page);
  await expect(page.getByRole('spinbutton', { name: 'Drop below confidence' })).toBeVisible();
  const drawn: Buffer[] = [];
  for (const [colour, words] of [['source', 'predicted'], ['deviation', 'mm from the tooth'], ['quality', 'equilateral'],
                                 ['uncertainty', 'true surface'], ['confidence', 'how surely']] as const) {
    await page.getByRole('combobox', { name: 'Colour' }).selectOption(colour);
    await expect(page.locator('#legend')).toContainText(words);
    let now = await drawing(page);
    await expect.poll(async () => {
      now = await drawing(page);
      return drawn.some((other) => now.equals(other));
    }, colour).toBe(false);
    drawn.push(now);
  }
  await expect(page.locator('#colouring option[value="clearance"]')).toHaveAttribute('disabled', '');
});

test('views, switches, keys and measuring', async ({ page, url }) => {
  await openSample(page, url, 'crown_11.stl');
  let before = await drawing(page);
  const changes = async (what: string): Promise<void> => {
    await expect.poll(async () => (await drawing(page)).equals(before), { message: what }).toBe(false);
    before = await drawing(page);
  };
  for (const key of ['3', '5', '1', 'w', 'w', 'x', 'x', 'c', 'c', 'g']) {
    await page.locator('#view').press(key);
    await changes(key);
  }
  await expect(page.locator('#hint')).toContainText('80 %');
  await page.keyboard.press('g');
  await changes('g off');
  for (const key of ['ArrowLeft', 'ArrowUp', '+', '0']) {
    await page.locator('#view').press(key);
    await changes(key);
  }
  await page.keyboard.press('m');
  await expect(page.locator('#hint')).toContainText('first point');
  await page.locator('#view').press('Enter');
  await expect(page.locator('#hint')).toContainText('second point');
  const box = await page.locator('#view').boundingBox();
  if (!box) throw new Error('no view');
  await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2 + 40);
  await expect(page.locator('#hint')).toContainText(/Distance: \d+\.\d\d mm/);
  const measured = Number(await page.locator('#view').getAttribute('data-measured'));
  expect(measured).toBeGreaterThan(0.5);
  expect(measured).toBeLessThan(15);
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2 + 80, box.y + box.height / 2 + 20, { steps: 4 });
  await page.mouse.up();
  await changes('orbit');
  await page.mouse.wheel(0, -300);
  await changes('zoom');
});

test('e, number and repair make the tooth anew', async ({ page, url }) => {
  await openSample(page, url, 'crown_36.stl');
  const zip = page.getByRole('link', { name: 'All as ZIP' });
  const first = await zip.getAttribute('href');
  await page.getByRole('spinbutton', { name: 'Mesh width e' }).fill('1');
  await page.getByRole('spinbutton', { name: 'Mesh width e' }).press('Enter');
  await expect.poll(() => zip.getAttribute('href')).not.toBe(first);
  const second = await zip.getAttribute('href');
  await page.getByRole('button', { name: 'Tooth 46' }).click();
  await expect(page.getByRole('button', { name: 'Tooth 46' })).toHaveAttribute('aria-pressed', 'true');
  await expect.poll(() => zip.getAttribute('href'), { timeout: 20_000 }).not.toBe(second);
});

test('two tabs do not disturb each other, and a reload keeps the tooth', async ({ page, url, context }) => {
  await openSample(page, url, 'crown_36.stl');
  const other = await context.newPage();
  await openSample(other, url, 'crown_23.ply');
  await expect(other.locator('#facts')).toContainText('23');
  await page.reload();
  await completed(page);
  await expect(page.locator('#facts')).toContainText('36');
  await other.close();
});
