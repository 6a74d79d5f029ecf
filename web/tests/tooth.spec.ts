// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

import { coarse, completed, drawing, drop, expect, openSample, program, redrawn, samples, test } from './program';
import type { Download, Page } from '@playwright/test';

test.use({ viewport: { width: 1024, height: 640 } });  // less to draw

async function download(page: Page, name: string): Promise<Download> {
  const [file] = await Promise.all([page.waitForEvent('download'), page.getByRole('link', { name, exact: true }).click()]);
  return file;
}

test.describe('as the page has it', () => {
  test.use({ e: null });

  test('a crown that is dropped becomes a tooth, its stages shown as they happen, its file that of the command line', async ({ page, url }) => {
    await page.goto(url);
    await page.evaluate(() => {
      const seen: string[] = [];
      new MutationObserver(() => {
        for (const item of document.querySelectorAll('#stages li'))
          if (!seen.includes(item.textContent ?? '')) seen.push(item.textContent ?? '');
        document.body.dataset['seen'] = seen.join(',');
      }).observe(document.getElementById('stages') as HTMLElement, { childList: true, subtree: true });
    });
    await drop(page, [{ name: 'crown_36.stl', bytes: readFileSync(join(samples, 'crown_36.stl')) }]);
    await completed(page);
    const seen = (await page.evaluate(() => document.body.dataset['seen'])) ?? '';
    for (const stage of ['crown', 'completion network', 'guiding surface', 'joining', 'proof']) expect(seen).toContain(stage);
    await expect(page.locator('#facts')).toContainText('crown exact, closed solid');
    await expect(page.getByRole('button', { name: 'Tooth 36' })).toHaveAttribute('aria-current', 'true');
    await expect(page.locator('#notice')).toBeInViewport();
    const own = join(mkdtempSync(join(tmpdir(), 'rhizodont-web-')), 'tooth.ply');
    execFileSync(program, ['complete', join(samples, 'crown_36.stl'), '-o', own, '--quiet']);
    expect(readFileSync(await (await download(page, 'PLY')).path()).equals(readFileSync(own))).toBe(true);
  });
});

test('files in every format are, to the byte, those of the command line', async ({ page, url }) => {
  await openSample(page, url, 'crown_36.stl');
  const folder = mkdtempSync(join(tmpdir(), 'rhizodont-web-'));
  await (await download(page, 'All as ZIP')).saveAs(join(folder, 'all.zip'));
  execFileSync('/usr/bin/python3', ['-m', 'zipfile', '-e', join(folder, 'all.zip'), join(folder, 'all')]);
  for (const ending of ['ply', 'stl', 'obj', 'glb']) {
    const file = await download(page, ending.toUpperCase());
    expect(file.suggestedFilename()).toBe(`tooth_36.${ending}`);
    const own = join(folder, `tooth.${ending}`);
    execFileSync(program, ['complete', join(samples, 'crown_36.stl'), '--e', String(coarse), '-o', own, '--quiet']);
    expect(readFileSync(await file.path()).equals(readFileSync(own)), ending).toBe(true);
    expect(readFileSync(join(folder, 'all', `tooth.${ending}`)).equals(readFileSync(own)), `${ending} in the ZIP`).toBe(true);
  }
  const report = readFileSync(await (await download(page, 'Report (JSON)')).path(), 'utf8');
  expect(JSON.parse(report)).toHaveProperty('report_version', 3);
  expect(JSON.parse(readFileSync(join(folder, 'all', 'report.json'), 'utf8'))).toEqual(JSON.parse(report));
  const page_ = readFileSync(await (await download(page, 'Report')).path(), 'utf8');
  expect(page_).toContain('id="rhizodont-report"');
});

test('a root is lengthened, turned, bent, undone and reset', async ({ page, url }) => {
  await openSample(page, url, 'crown_36.stl');
  const length = page.getByRole('spinbutton', { name: 'Length, mm' });
  const first = await length.inputValue();
  const before = await drawing(page);
  await length.fill('18.5');
  await length.press('Enter');
  await expect(page.locator('#facts')).toContainText('set by you');
  await expect(page.locator('#facts')).toContainText('18.');
  let drawn = await redrawn(page, before, 'length');
  for (const name of ['Tip', 'Torque', 'Bend']) {
    const slider = page.getByRole('slider', { name }), box = page.getByRole('spinbutton', { name });
    await box.fill('12');
    await box.press('Enter');
    drawn = await redrawn(page, drawn, name);
    await slider.focus();
    await page.keyboard.press('ArrowRight');
    await expect(slider).toBeFocused();
    await expect(box).toHaveValue('13');
    await page.keyboard.press('Control+z');
    await expect(box).toHaveValue('12');
  }
  await page.getByRole('button', { name: 'Reset' }).click();
  await expect(page.locator('#facts')).not.toContainText('set by you');
  await expect(length).toHaveValue(first);
  await expect.poll(async () => (await drawing(page)).equals(before)).toBe(true);
});

test('every colour of a tooth is shown with its legend', async ({ page, url }) => {
  await openSample(page, url, 'skirt_36.ply');
  const zip = page.getByRole('link', { name: 'All as ZIP' });
  const kept = await zip.getAttribute('href');
  await page.getByRole('combobox', { name: 'Gum around the crown' }).selectOption('drop');
  await expect.poll(() => zip.getAttribute('href')).not.toBe(kept);
  await completed(page);
  const drawn: Buffer[] = [];
  for (const [colour, words] of [['source', 'predicted'], ['deviation', 'mm from the tooth'], ['quality', 'equilateral'],
                                 ['uncertainty', 'true surface'], ['confidence', 'how surely']] as const) {
    await page.getByRole('combobox', { name: 'Colour' }).selectOption(colour);
    await expect(page.locator('#legend')).toContainText(words);
    let now = await drawing(page);
    await expect.poll(async () => {
      now = await drawing(page);
      return drawn.some((other) => now.equals(other));
    }, { message: colour, intervals: [20, 50, 100] }).toBe(false);
    drawn.push(now);
  }
  await expect(page.locator('#colouring option[value="clearance"]')).toHaveAttribute('disabled', '');  // labels.spec.ts has it
  const dropped = await zip.getAttribute('href');
  const threshold = page.getByRole('spinbutton', { name: 'Drop below confidence' });
  await threshold.fill('0.9');
  await threshold.press('Enter');
  await expect.poll(() => zip.getAttribute('href')).not.toBe(dropped);
});

test('views, switches, keys and measuring', async ({ page, url }) => {
  await openSample(page, url, 'crown_11.stl');
  let before = await drawing(page);
  const changes = async (what: string): Promise<void> => { before = await redrawn(page, before, what); };
  for (const key of ['2', '3', '4', '5', '6', '1', 'w', 'w', 'x', 'x', 'c', 'c', 'g']) {
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
  await page.keyboard.press('c');
  await changes('clipping');
  await page.getByRole('slider', { name: 'Clipping plane' }).fill('70');
  await changes('the plane moved');
  await page.locator('#view').press('c');
  await changes('clipping off');
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
  before = await drawing(page);
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2 + 80, box.y + box.height / 2 + 20, { steps: 4 });
  await page.mouse.up();
  await changes('orbit');
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down({ button: 'right' });
  await page.mouse.move(box.x + box.width / 2 + 60, box.y + box.height / 2, { steps: 4 });
  await page.mouse.up({ button: 'right' });
  await changes('pan');
  await page.mouse.wheel(0, -300);
  await changes('zoom');
});

test('e, number and repair make the tooth anew', async ({ page, url }) => {
  await openSample(page, url, 'crown_36.stl');
  const zip = page.getByRole('link', { name: 'All as ZIP' });
  let address = await zip.getAttribute('href');
  const isNew = async (): Promise<void> => {
    await expect.poll(() => zip.getAttribute('href')).not.toBe(address);
    address = await zip.getAttribute('href');
  };
  await page.getByRole('spinbutton', { name: 'Mesh width e' }).fill('1');
  await page.getByRole('spinbutton', { name: 'Mesh width e' }).press('Enter');
  await isNew();
  await page.getByRole('button', { name: 'Tooth 46' }).click();
  await isNew();
  await expect(page.getByRole('button', { name: 'Tooth 46' })).toHaveAttribute('aria-pressed', 'true');
  await page.getByRole('checkbox', { name: 'Repair' }).check();
  await isNew();
  await expect(page.getByRole('checkbox', { name: 'Repair' })).toBeChecked();
});

test('all of it goes by keyboard', async ({ page, url }) => {
  await page.goto(url);
  await expect(page.locator('[data-sample]').first()).toBeVisible();
  const tabTo = async (what: string): Promise<void> => {
    for (let presses = 0; presses < 120; ++presses) {
      await page.keyboard.press('Tab');
      if (await page.evaluate((selector) => document.activeElement?.matches(selector) ?? false, what)) return;
    }
    throw new Error(`Tab does not lead to ${what}`);
  };
  await tabTo('[data-sample="crown_23.ply"]');
  await page.keyboard.press('Enter');
  await completed(page);
  await tabTo('#view');
  let before = await drawing(page);
  await page.keyboard.press('5');
  before = await redrawn(page, before, 'a view');
  await tabTo('[data-focus="length-box"]');
  await page.keyboard.press('Control+a');
  await page.keyboard.type('20');
  await page.keyboard.press('Enter');
  await expect(page.locator('#facts')).toContainText('set by you');
  await tabTo('a[download$=".stl"]');
  const [file] = await Promise.all([page.waitForEvent('download'), page.keyboard.press('Enter')]);
  expect(file.suggestedFilename()).toBe('tooth_23.stl');
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
