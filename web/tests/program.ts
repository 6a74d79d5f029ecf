// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import { spawn, type ChildProcess } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

import { AxeBuilder } from '@axe-core/playwright';
import { test as base, expect, type Page } from '@playwright/test';

/** The source tree: given by the build, which runs the tests in its own folder. */
export const source = process.env['RHIZODONT_SOURCE'] ?? fileURLToPath(new URL('../..', import.meta.url));
export const program = process.env['RHIZODONT_PROGRAM'] ?? join(source, 'build/apps/rhizodont/rhizodont');
export const samples = join(source, 'samples');
export const data = join(source, '../shared/data');
export const hasData = existsSync(data);
/** Where pictures for a person to look at go. */
export const pictures = process.env['RHIZODONT_PICTURES'] ?? mkdtempSync(join(tmpdir(), 'rhizodont-pictures-'));

async function served(): Promise<{ url: string; child: ChildProcess }> {
  const child = spawn(program, ['serve', '--port', '0', '--quiet']);
  const url = await new Promise<string>((resolve, reject) => {
    let said = '';
    child.stdout.on('data', (bytes: Buffer) => {
      said += bytes.toString();
      const found = /http:\/\/127\.0\.0\.1:\d+\//.exec(said);
      if (found) resolve(found[0]);
    });
    child.on('exit', (code) => reject(new Error(`the program ended with ${code}: ${said}`)));
  });
  return { url, child };
}

/** The mesh width that teeth are made with where a test does not ask for another: few triangles, for little time. */
export const coarse = 1.5;

interface Fixtures {
  faults: string[];
  e: number | null;  // mm, in place of the page's 0.5; null: as the page has it
  coarseJobs: void;
}

/** Tests with a program of their own worker, and a page whose errors are the test's. */
export const test = base.extend<Fixtures, { url: string }>({
  e: [coarse, { option: true }],
  coarseJobs: [async ({ context, e }, use) => {
    if (e !== null)
      await context.route('**/api/v1/jobs', async (route) => {
        const sent = route.request().postDataJSON() as { options?: { e_mm?: number } } | null;
        if (sent?.options?.e_mm !== 0.5) return route.continue();
        await route.continue({ postData: JSON.stringify({ ...sent, options: { ...sent.options, e_mm: e } }) });
      });
    await use();
  }, { auto: true }],
  url: [async ({}, use) => {
    const { url, child } = await served();
    await use(url);
    child.removeAllListeners('exit');
    const end = new Promise((resolve) => child.on('exit', resolve));
    expect([child.exitCode, child.signalCode], 'the program still runs').toEqual([null, null]);
    child.kill('SIGTERM');
    expect(await end, 'the program ends as it should').toBe(0);
  }, { scope: 'worker' }],
  faults: [async ({ page }, use) => {
    const faults: string[] = [];
    page.on('pageerror', (error) => faults.push(error.message));
    page.on('console', (message) => {
      // Chromium logs every 4xx as an error; what the page makes of those is tested by what it says.
      if (message.type() === 'error' && !message.text().startsWith('Failed to load resource')) faults.push(message.text());
    });
    page.on('request', (request) => {
      if (!/^(http:\/\/127\.0\.0\.1:|data:|blob:|file:)/.test(request.url())) faults.push('went to ' + request.url());
    });
    await use(faults);
    expect(faults).toEqual([]);
  }, { auto: true }],
});

export { expect };

/** Drops files on the page as a person would. */
export async function drop(page: Page, files: { name: string; bytes: Buffer }[]): Promise<void> {
  const transfer = await page.evaluateHandle((sent) => {
    const made = new DataTransfer();
    for (const { name, text } of sent)
      made.items.add(new File([Uint8Array.from(atob(text), (c) => c.charCodeAt(0))], name));
    return made;
  }, files.map(({ name, bytes }) => ({ name, text: bytes.toString('base64') })));
  await page.dispatchEvent('#stage', 'dragover', { dataTransfer: transfer });
  await page.dispatchEvent('#stage', 'drop', { dataTransfer: transfer });
}

/** Waits until the view is drawn otherwise than before, and gives it. */
export async function redrawn(page: Page, before: Buffer, what: string): Promise<Buffer> {
  let now = before;
  await expect.poll(async () => {
    now = await drawing(page);
    return now.equals(before);
  }, { message: what, intervals: [20, 50, 100] }).toBe(false);
  return now;
}

/** Nothing that axe finds, in either theme. */
export async function accessible(page: Page, themes: readonly ('light' | 'dark')[] = ['light', 'dark']): Promise<void> {
  for (const theme of themes) {
    await page.emulateMedia({ colorScheme: theme });
    await expect(page.locator('html')).toHaveAttribute('data-theme', theme);
    expect((await new AxeBuilder({ page }).analyze()).violations, theme).toEqual([]);
  }
}

/** Waits until a job has ended well and is in view. */
export async function completed(page: Page): Promise<void> {
  await expect(page.locator('#hint')).toContainText(/Done in|Fertig in/, { timeout: 60_000 });
  await expect(page.locator('#progress')).toBeHidden();
}

export async function openSample(page: Page, url: string, name: string): Promise<void> {
  await page.goto(url);
  await page.click(`[data-sample="${name}"]`);
  await completed(page);
}

/** The view as drawn, to compare. */
export async function drawing(page: Page): Promise<Buffer> {
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  const box = await page.locator('#view').boundingBox();
  if (!box) throw new Error('no view');
  return page.screenshot({ clip: { x: box.x + box.width * 0.3, y: box.y + box.height * 0.25, width: box.width * 0.4, height: box.height * 0.6 } });
}

/**
 * A scan of two lower molars that touch (OBJ) with labels (Teeth3DS): both 36, as where two teeth were taken for one, or 36 and 37.
 */
export function twoMolars(areTold = false): { scan: Buffer; labels: Buffer } {
  const stl = readFileSync(join(samples, 'crown_36.stl'));
  const numbers = new Map<string, number>();
  const vertices: [number, number, number][] = [];
  const triangles: [number, number, number][] = [];
  for (let t = 0; t < stl.readUInt32LE(80); ++t)
    triangles.push([0, 1, 2].map((corner) => {
      const at = 84 + 50 * t + 12 + 12 * corner;
      const key = stl.subarray(at, at + 12).toString('hex');
      const known = numbers.get(key);
      if (known !== undefined) return known;
      numbers.set(key, vertices.length);
      return vertices.push([stl.readFloatLE(at), stl.readFloatLE(at + 4), stl.readFloatLE(at + 8)]) - 1;
    }) as [number, number, number]);
  const xs = vertices.map(([x]) => x);
  const width = Math.max(...xs) - Math.min(...xs) - 1;  // so that one sees no gap between them
  const lines: string[] = [];
  for (const shift of [0, width]) for (const [x, y, z] of vertices) lines.push(`v ${Math.fround(x + shift)} ${y} ${z}`);
  for (const shift of [0, vertices.length]) for (const corners of triangles) lines.push('f ' + corners.map((v) => v + 1 + shift).join(' '));
  const labels = { jaw: 'lower', labels: Array.from({ length: 2 * vertices.length }, (_, v) => (areTold && v >= vertices.length ? 37 : 36)) };
  return { scan: Buffer.from(lines.join('\n') + '\n'), labels: Buffer.from(JSON.stringify(labels)) };
}

/** Of windows that everything is to fit: two screens and a tablet. */
export const sizes = [[1280, 720], [1920, 1080], [1024, 768]] as const;

/** Pairs of visible parts of the page that lie over each other and should not. */
export async function overlaps(page: Page): Promise<string[]> {
  return page.evaluate(() => {
    const ids = ['bar', 'legend', 'hint', 'panel', 'notice', 'said', 'welcome'];
    const boxes = ['header', ...ids.map((id) => '#' + id)].flatMap((name) => {
      const box = document.querySelector(name)?.getBoundingClientRect();
      return box && box.width > 0 && box.height > 0 ? [{ name, box }] : [];
    });
    const found: string[] = [];
    boxes.forEach((a, i) => boxes.slice(i + 1).forEach((b) => {
      const wide = Math.min(a.box.right, b.box.right) - Math.max(a.box.left, b.box.left);
      const high = Math.min(a.box.bottom, b.box.bottom) - Math.max(a.box.top, b.box.top);
      if (wide > 1 && high > 1) found.push(`${a.name} and ${b.name}`);
    }));
    for (const e of document.querySelectorAll<HTMLElement>('header, #bar, #legend, #hint, #notice, #panel'))
      if (e.scrollWidth > e.clientWidth + 1) found.push(`${e.id || e.tagName} is cut off`);
    return found;
  });
}
