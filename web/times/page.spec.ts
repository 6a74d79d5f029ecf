// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import { execFileSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

import { completed, drop, expect, openSample, program, samples, test } from '../tests/program';
import type { Page } from '@playwright/test';

test.use({ e: null });

const median = (numbers: number[]): number => [...numbers].sort((a, b) => a - b)[Math.floor(numbers.length / 2)] ?? NaN;

function say(what: string, seconds: number[], limit: number): void {
  const most = Math.max(...seconds);
  console.log(`${what}: ${median(seconds).toFixed(2)} s (median of ${seconds.length}), at most ${most.toFixed(2)} s; ` +
              `${limit} s ${most <= limit ? 'holds' : 'does NOT hold'}`);
}

test('from a drop to the tooth, warm', async ({ page, url }) => {
  await openSample(page, url, 'crown_34.ply');
  const crown = readFileSync(join(samples, 'crown_36.stl'));
  const seconds: number[] = [];
  for (let round = 0; round < 7; ++round) {
    await page.click('#another');
    await expect(page.locator('#welcome')).toBeVisible();
    await page.evaluate(() => {
      document.addEventListener('drop', () => { document.body.dataset['dropped'] = String(performance.now()); }, { capture: true, once: true });
      const until = (): void => {
        if (document.getElementById('hint')?.hidden !== false || document.getElementById('progress')?.hidden !== true) requestAnimationFrame(until);
        else requestAnimationFrame(() => { document.body.dataset['seen'] = String(performance.now()); });
      };
      delete document.body.dataset['seen'];
      requestAnimationFrame(until);
    });
    await drop(page, [{ name: 'crown_36.stl', bytes: crown }]);
    await completed(page);
    await page.waitForFunction(() => document.body.dataset['seen'] !== undefined);
    seconds.push(await page.evaluate(() => (Number(document.body.dataset['seen']) - Number(document.body.dataset['dropped'])) / 1000));
  }
  say('first result after the drop of samples/crown_36.stl', seconds, 3);
});

test('from a slider to the root', async ({ page, url }) => {
  await openSample(page, url, 'crown_36.stl');
  for (const [name, values] of [['Length', [12, 14, 16, 18, 13, 15, 17]], ['Tip', [5, -5, 8, 3]], ['Torque', [5, -5, 8, 3]], ['Bend', [10, -10, 20, 4]]] as const) {
    const seconds: number[] = [];
    for (const value of values)
      seconds.push(await page.getByRole('slider', { name }).evaluate((slider: HTMLInputElement, to) => new Promise<number>((done) => {
        const begun = performance.now();
        const drawn = document.getElementById('view')?.dataset['drawn'];
        slider.value = String(to);
        for (const event of ['input', 'change']) slider.dispatchEvent(new Event(event));
        const until = (): void => {
          if (document.getElementById('view')?.dataset['drawn'] === drawn || document.getElementById('stage')?.getAttribute('aria-busy') !== 'false') requestAnimationFrame(until);
          else requestAnimationFrame(() => done((performance.now() - begun) / 1000));
        };
        requestAnimationFrame(until);
      }), value));
    say(`another root, ${name.toLowerCase()}`, seconds, 1);
  }
});

/** Fourteen molar crowns along an arch: what they are does not matter to who draws them. */
function fourteenCrowns(folder: string): void {
  const stl = readFileSync(join(samples, 'crown_36.stl'));
  for (let place = 0; place < 14; ++place) {
    const angle = (Math.PI * (place + 0.5)) / 14;
    const shift = [55 * Math.cos(angle), 65 * Math.sin(angle)];
    const moved = Buffer.from(stl);
    for (let t = 0; t < moved.readUInt32LE(80); ++t)
      for (let corner = 0; corner < 3; ++corner)
        for (const k of [0, 1]) {
          const at = 84 + 50 * t + 12 + 12 * corner + 4 * k;
          moved.writeFloatLE(moved.readFloatLE(at) + (shift[k] ?? 0), at);
        }
    writeFileSync(join(folder, `crown_${place < 7 ? 47 - place : 24 + place}.stl`), moved);
  }
}

/** Processor time of this process's descendants, the browser among them: it depends little on what else the machine does. */
function browserSeconds(): number {
  const stats = readdirSync('/proc').filter((name) => /^\d+$/.test(name)).flatMap((id) => {
    try {
      const fields = readFileSync(`/proc/${id}/stat`, 'utf8').replace(/^.*\) /, '').split(' ');
      return [{ id: Number(id), parent: Number(fields[1]), ticks: Number(fields[11]) + Number(fields[12]) }];
    } catch {  // it has ended
      return [];
    }
  });
  const family = new Set([process.pid]);
  for (let size = 0; size !== family.size;) {
    size = family.size;
    for (const { id, parent } of stats) if (family.has(parent)) family.add(id);
  }
  return stats.filter(({ id }) => id !== process.pid && family.has(id)).reduce((sum, { ticks }) => sum + ticks, 0) / 100;
}

interface Frames { seconds: number; longest: number; count: number }

/** Turns the view by the mouse for some seconds, and tells the frames between. */
async function turned(page: Page, seconds: number): Promise<Frames> {
  const box = await page.locator('#view').boundingBox();
  if (!box) throw new Error('no view');
  const at = (angle: number): [number, number] => [box.x + box.width * (0.5 + 0.3 * Math.cos(angle)), box.y + box.height * (0.5 + 0.2 * Math.sin(angle))];
  await page.mouse.move(...at(0));
  await page.evaluate(() => {
    const times: number[] = [];
    let drawn = '';
    const frame = (now: number): void => {
      const { drawn: next = '' } = (document.getElementById('view') as HTMLElement).dataset;
      if (next !== drawn) times.push(now);
      drawn = next;
      if (document.body.dataset['turning'] !== 'ended') requestAnimationFrame(frame);
      else document.body.dataset['frames'] = JSON.stringify(times);
    };
    document.body.dataset['turning'] = 'begun';
    delete document.body.dataset['frames'];
    requestAnimationFrame(frame);
  });
  await page.evaluate(() => { document.body.dataset['down'] = String(performance.now()); });
  await page.mouse.down();
  const begun = Date.now();
  for (let step = 0; Date.now() - begun < 1000 * seconds; ++step) await page.mouse.move(...at(step / 12));
  await page.mouse.up();
  await page.evaluate(() => { document.body.dataset['turning'] = 'ended'; });
  await page.waitForFunction(() => document.body.dataset['frames'] !== undefined);
  const times = JSON.parse((await page.evaluate(() => document.body.dataset['frames'])) ?? '[]') as number[];
  const down = Number(await page.evaluate(() => document.body.dataset['down']));
  const drawn = times.filter((time) => time > down);
  const gaps = drawn.map((time, i) => (time - (drawn[i - 1] ?? down)) / 1000);
  return { seconds: ((drawn.at(-1) ?? down) - down) / 1000, longest: Math.max(...gaps), count: gaps.length };
}

test('an arch of fourteen teeth turns', async ({ page }) => {
  const folder = mkdtempSync(join(tmpdir(), 'rhizodont-times-'));
  mkdirSync(join(folder, 'crowns'));
  fourteenCrowns(join(folder, 'crowns'));
  const report = join(folder, 'arch.html');
  execFileSync(program, ['arch', join(folder, 'crowns'), '-o', join(folder, 'out'), '--e', process.env['RHIZODONT_ARCH_E'] ?? '0.35', '--report', report, '--quiet']);
  const opened = Date.now();
  await page.goto('file://' + report);
  await page.waitForFunction(() => Number(document.getElementById('view')?.dataset['drawn'] ?? 0) > 0);
  console.log(`opened in ${((Date.now() - opened) / 1000).toFixed(1)} s`);
  for (const [width, height] of [[1280, 720]] as const) {
    await page.setViewportSize({ width, height });
    for (const colour of ['source', 'uncertainty', 'quality', 'deviation']) {
      await page.getByRole('combobox', { name: 'Colour' }).selectOption(colour);
      await page.waitForTimeout(1000);
      const before = browserSeconds();
      const frames = await turned(page, 4);
      const work = browserSeconds() - before;
      const triangles = Number(await page.locator('#view').getAttribute('data-triangles'));
      console.log(`${triangles} triangles at ${width} x ${height}, ${colour}: ${(frames.count / frames.seconds).toFixed(1)} frames/s, ` +
                  `longest ${(1000 * frames.longest).toFixed(0)} ms, ${(1000 * work / frames.count).toFixed(0)} ms of processors a frame`);
      await page.waitForTimeout(600);  // drawn in full again
    }
  }
});
