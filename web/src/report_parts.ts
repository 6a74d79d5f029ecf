// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import { element } from './dom';
import { number, text, type TextKey } from './texts';

// What the pages of all reports are made of.

/** What all reports have in common, as the program writes them (docs/report.schema.json, docs/arch_report.schema.json). */
export interface AnyReport {
  program: { name: string; version: string };
  input: { file: string | null; sha256: string | null };
  options: Record<string, unknown>;
  model?: Record<string, string>;
}

export function list(rows: [TextKey, string | null | undefined][]): HTMLElement {
  const made = element('dl');
  for (const [name, value] of rows) if (value) made.append(element('dt', {}, text(name)), element('dd', {}, value));
  return made;
}

export function section(name: TextKey, ...children: Node[]): HTMLElement {
  return element('section', {}, element('h2', {}, text(name)), ...children);
}

/** A bar chart; its figures are there as words, too. */
export function bars(rows: [string, number][], unit: string, digits: number): HTMLElement {
  const most = Math.max(...rows.map(([, value]) => value), 1e-9);
  const table = element('table', { class: 'bars' });
  for (const [name, value] of rows) {
    const bar = element('span', { class: 'of-bars' });
    bar.style.width = `${(100 * value) / most}%`;
    table.append(element('tr', {}, element('th', { scope: 'row' }, name), element('td', { class: 'wide' }, bar), element('td', {}, `${number(value, digits)}${unit}`)));
  }
  return table;
}

/** Rows of words below a row of headings. The first of each row is its name. */
export function table(caption: TextKey, head: TextKey[], rows: string[][]): HTMLElement {
  const made = element('table', {}, element('caption', { class: 'hidden' }, text(caption)),
                       element('thead', {}, element('tr', {}, ...head.map((key) => element('th', { scope: 'col' }, text(key))))),
                       element('tbody', {}, ...rows.map(([name = '', ...values]) => element('tr', {}, element('th', { scope: 'row' }, name), ...values.map((value) => element('td', {}, value))))));
  return element('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': text(caption) }, made);
}

export function notes(sentences: string[]): Node[] {
  return sentences.length === 0 ? [] : [section('fact.warnings', element('ul', { class: 'notes', lang: 'en' }, ...sentences.map((sentence) => element('li', {}, sentence))))];
}

function folded(name: TextKey, json: unknown): HTMLElement {
  return element('details', {}, element('summary', {}, text(name)), element('pre', {}, JSON.stringify(json, null, 1)));
}

/** Which file, program, models and options a report is of. */
export function provenance(report: AnyReport, models: Record<string, string>): HTMLElement {
  return section('report.provenance', list([
    ['report.file', report.input.file], ['report.input', report.input.sha256], ['report.program', `${report.program.name} ${report.program.version}`],
  ]), folded('report.options', report.options), folded('report.hashes', models), ...(report.model ? [folded('report.model', report.model)] : []));
}
