// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import { element } from './dom';
import { bars, list, notes, provenance, section, type AnyReport } from './report_parts';
import { isTextKey, number, text } from './texts';
import type { ViewMesh } from './view_mesh';

/** The parts of docs/report.schema.json that are shown. */
export interface ToothReport extends AnyReport {
  fdi?: { number: number; guessed: boolean };
  likeness?: { said: { fdi: number; probability: number }; verdict: string } | null;
  crown?: { triangles: number; kept_triangles: number };
  frame?: { rotation: [number, number, number][] };
  root?: { length_mm: number; interval: { length_low_mm: number; length_high_mm: number; apex_radius_mm: number } | null };
  new_triangles?: { q_avg: number; theta_min: number; percent_below_30: number };
  promises?: { crown: { holds: boolean; deviation: { bins: number[] } | null }; solid: { holds: boolean; genus: number | null } };
  stages?: { name: string; seconds: number }[];
  refused?: { sentence: string; kind: string; ids: unknown[] };
  warnings: string[];
}

/** How many of the triangles that are not the crown's have which quality. */
function qualityBars(mesh: ViewMesh | undefined): [string, number][] {
  const quality = mesh?.perTriangle.get('quality');
  const source = mesh?.perVertex.get('source');
  if (!mesh || !quality || !source) return [];
  const counts = [0, 0, 0, 0, 0];
  let all = 0;
  quality.forEach((q, t) => {
    const isOld = [0, 1, 2].every((k) => source[mesh.index[3 * t + k] as number] === 0);
    if (isOld) return;
    const bin = q < 0.6 ? 0 : Math.min(4, Math.floor((q - 0.6) * 10) + 1);
    counts[bin] = (counts[bin] as number) + 1;
    ++all;
  });
  return ['< 0.6', '0.6 – 0.7', '0.7 – 0.8', '0.8 – 0.9', '0.9 – 1'].map((name, i) => [name, (100 * (counts[i] as number)) / Math.max(1, all)]);
}

function facts(report: ToothReport): HTMLElement {
  const { root, crown, promises, likeness } = report;
  return section('section.results', list([
    ['fact.tooth', report.fdi && `${report.fdi.number}${report.fdi.guessed ? ` (${text('fact.guessed')})` : ''}`],
    ['report.likeness', likeness && `${likeness.said.fdi}: ${number(100 * likeness.said.probability, 0)} %`],
    ['fact.kept', crown && text('fact.of', { kept: number(crown.kept_triangles, 0), all: number(crown.triangles, 0) })],
    ['fact.root', root && `${number(root.length_mm, 1)} mm`],
    ['fact.interval', root?.interval && `${number(root.interval.length_low_mm, 1)} – ${number(root.interval.length_high_mm, 1)} mm`],
    ['report.apex', root?.interval && `${number(root.interval.apex_radius_mm, 1)} mm`],
    ['fact.proved', promises?.crown.holds && promises.solid.holds ? text('fact.proved.yes') : null],
  ]));
}

export function toothParts(report: ToothReport, models: Record<string, string>, tooth: ViewMesh | undefined): Node[] {
  const made: Node[] = [];
  if (report.refused)
    made.push(section('state.refused', element('p', { lang: 'en', class: 'refused' }, report.refused.sentence),
                      element('p', {}, report.refused.ids.length > 0 ? text('error.ids', { count: report.refused.ids.length }) : '')));
  else made.push(facts(report));
  made.push(...notes(report.warnings));
  const { new_triangles: fresh, promises } = report;
  if (fresh && promises)
    made.push(section('report.proof', list([
      ['fact.quality', number(fresh.q_avg, 3)],
      ['report.genus', promises.solid.genus === null ? null : String(promises.solid.genus)],
      ['report.deviation', promises.crown.deviation?.bins.map((n) => number(n, 0)).join(' / ')],
    ])), section('report.angles', bars(qualityBars(tooth), ' %', 1)));
  if (report.stages)
    made.push(section('report.stages', bars(report.stages.map(({ name, seconds }) => {
      const key = 'stage.' + name;
      return [isTextKey(key) ? text(key) : name, seconds];
    }), ' ' + text('report.seconds'), 2)));
  made.push(provenance(report, models));
  return made;
}
