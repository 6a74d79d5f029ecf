// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import { element } from './dom';
import { list, notes, provenance, section, type AnyReport } from './report_parts';
import { quadrants } from './settings';
import { number, text, type TextKey } from './texts';
import type { Viewer } from './viewer';

/** The parts of docs/arch_report.schema.json that are shown. */
export interface ArchReport extends AnyReport {
  arch_report_version: number;
  found: { fdi: number; confidence: number }[];
  rooted: number;
  teeth: {
    fdi: number; rooted: boolean; refusal: string | null; crown_triangles?: number; kept_crown_triangles?: number; root_length_mm?: number;
    root_length_80_percent_mm?: [number, number] | null; warnings?: string[];
  }[];
  clearances: { teeth: [number, number]; root_root_mm: number | null; root_crown_mm: number | null; crown_root_mm: number | null }[];
  upright: [number, number, number][] | null;
  notes: string[];
}

function ofRoots(report: ArchReport, fdi: number | null): { teeth: [number, number]; mm: number }[] {
  return report.clearances.filter((c) => fdi === null || c.teeth.includes(fdi)).flatMap((c) => {
    const all = [c.root_root_mm, c.root_crown_mm, c.crown_root_mm].filter((mm): mm is number => mm !== null);
    return all.length > 0 ? [{ teeth: c.teeth, mm: Math.min(...all) }] : [];
  });
}

function measuredIn(report: ArchReport): Record<string, number> {
  return (report.options as { root_lengths_mm?: Record<string, number> }).root_lengths_mm ?? {};
}

function rows(report: ArchReport): HTMLElement[] {
  const measured = measuredIn(report);
  return report.teeth.map((tooth) => {
    const found = report.found.find((each) => each.fdi === tooth.fdi);
    const percent = found ? number(100 * found.confidence, 0) : '';
    const row = element('tr', {}, element('th', { scope: 'row', title: found ? text('table.found', { percent }) : '' }, String(tooth.fdi),
                                          ...(found ? [element('small', {}, ` ${percent} %`)] : [])));
    if (!tooth.rooted) {
      row.append(element('td', { class: 'why', colspan: 5 }, text('table.none') + ': ', element('span', { lang: 'en' }, tooth.refusal ?? '')));
      return row;
    }
    const near = ofRoots(report, tooth.fdi).map(({ mm }) => mm);
    const interval = tooth.root_length_80_percent_mm;
    const length = measured[String(tooth.fdi)];
    const cells = [
      `${number(tooth.kept_crown_triangles ?? 0, 0)} / ${number(tooth.crown_triangles ?? 0, 0)}`, number(tooth.root_length_mm ?? 0, 1),
      interval ? `${number(interval[0], 1)} – ${number(interval[1], 1)}` : '–', near.length > 0 ? number(Math.min(...near), 2) : '–',
    ];
    if (Object.keys(measured).length > 0) cells.push(length === undefined ? '' : number(length, 1));
    row.append(...cells.map((cell) => element('td', {}, cell)));
    return row;
  });
}

/** Shows and hides teeth. */
function chart(report: ArchReport, viewer: Viewer): HTMLElement {
  const group = element('div', { role: 'group', 'aria-label': text('chart.arch') });
  for (const jaw of ['upper', 'lower'] as const) {
    if (!quadrants[jaw].flat().some((fdi) => report.teeth.some((tooth) => tooth.fdi === fdi))) continue;
    const box = element('div', { class: 'chart', role: 'group', 'aria-label': text(`chart.${jaw}`) });
    for (const fdi of quadrants[jaw].flat()) {
      const isThere = report.teeth.some((tooth) => tooth.fdi === fdi);
      const button = element('button', {
        type: 'button', 'aria-label': text('tooth', { fdi }), 'aria-pressed': String(isThere && viewer.isShown(fdi)), disabled: !isThere,
        click: () => {
          viewer.show(fdi, !viewer.isShown(fdi));
          button.setAttribute('aria-pressed', String(viewer.isShown(fdi)));
        },
      }, String(fdi));
      box.append(button);
    }
    group.append(box);
  }
  return section('section.tooth', group);
}

export function archParts(report: ArchReport, models: Record<string, string>, viewer: Viewer): Node[] {
  const head: TextKey[] = ['table.tooth', 'table.kept', 'table.root', 'table.interval', 'table.clearance'];
  if (Object.keys(measuredIn(report)).length > 0) head.push('table.measured');
  const collisions = ofRoots(report, null).filter(({ mm }) => mm < 0);
  const made = element('table', {}, element('caption', { class: 'hidden' }, text('table.caption')),
                       element('thead', {}, element('tr', {}, ...head.map((key) => element('th', { scope: 'col' }, text(key))))), element('tbody', {}, ...rows(report)));
  const sentences = report.teeth.flatMap(({ fdi, warnings }) => (warnings ?? []).map((sentence) => `${fdi}: ${sentence}`));
  return [
    section('section.results', list([
      ['report.rooted', text('fact.of', { kept: report.rooted, all: report.teeth.length })],
      ['report.collisions', collisions.length === 0 ? text('report.none') : collisions.map(({ teeth, mm }) => `${teeth.join('/')}: ${number(-mm, 2)} mm`).join(', ')],
    ]), element('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': text('table.caption') }, made)),
    chart(report, viewer), ...notes([...report.notes, ...sentences]), provenance(report, models),
  ];
}
