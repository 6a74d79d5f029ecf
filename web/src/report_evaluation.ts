// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import { element } from './dom';
import { notes, provenance, section, table, type AnyReport } from './report_parts';
import { number, text, type TextKey } from './texts';

interface Means {
  teeth: number; root_length_abs_error_mm?: number; root_length_bias_mm?: number; apex_distance_mm?: number; root_chamfer_mm?: number; root_f_score?: number;
  root_hausdorff95_mm?: number; root_axis_angle_deg?: number;
}
interface Outcome {
  figures: { true_root_length_mm: number; root_length_error_mm: number; apex_distance_mm: number; root_chamfer_mm: number; root_f_score: number; root_hausdorff95_mm: number; root_axis_angle_deg: number } | null;
  failure: string | null;
}
/** The figures of `rhizodont evaluate` (--json) with their provenance. */
export interface EvaluationReport extends AnyReport {
  evaluation: {
    cases: { fdi: number; name: string; outcomes: Record<string, Outcome> }[];
    means: Record<string, Means>;
    means_by_type: Record<string, Record<string, Means>> | null;
    coverage: Record<string, { teeth: number; share_of_lengths_inside?: number; share_of_apices_inside?: number }>;
  };
  scanner_limits: string;
}

const figures: [TextKey, keyof Means, number][] = [
  ['report.lengthError', 'root_length_abs_error_mm', 2], ['report.bias', 'root_length_bias_mm', 2], ['report.apexOff', 'apex_distance_mm', 2],
  ['report.chamfer', 'root_chamfer_mm', 3], ['report.fscore', 'root_f_score', 3], ['report.hausdorff', 'root_hausdorff95_mm', 2], ['report.angle', 'root_axis_angle_deg', 1],
];

function meansRow(name: string, by: string, means: Means): string[] {
  return [name, by, number(means.teeth, 0), ...figures.map(([, key, digits]) => (means[key] === undefined ? '–' : number(means[key] ?? 0, digits)))];
}

/** Wide, for it takes the place of the view. */
export function evaluationParts(report: EvaluationReport, models: Record<string, string>, plot: string | undefined): { wide: Node[]; beside: Node[] } {
  const { cases, means, means_by_type: byType, coverage } = report.evaluation;
  const all = Object.entries(means).map(([by, each]) => meansRow(text('report.cases'), by, each));
  const types = Object.entries(byType ?? {}).flatMap(([type, of]) => Object.entries(of).map(([by, each]) => meansRow(type, by, each)));
  const held = Object.entries(coverage).filter(([, each]) => each.teeth > 0).map(([by, each]) =>
    `${by}: ${number(100 * (each.share_of_lengths_inside ?? 0), 0)} % ${text('report.ofLengths')}, ${number(100 * (each.share_of_apices_inside ?? 0), 0)} % ${text('report.ofApices')}`);
  const single = cases.flatMap(({ fdi, name, outcomes }) => Object.entries(outcomes).map(([by, { figures: f, failure }]) => {
    const row = [name ? `${fdi} ${name}` : String(fdi), by];
    return f ? [...row, number(f.true_root_length_mm, 1), number(f.true_root_length_mm + f.root_length_error_mm, 1), number(f.apex_distance_mm, 2), number(f.root_chamfer_mm, 3),
                number(f.root_f_score, 3), number(f.root_hausdorff95_mm, 2), number(f.root_axis_angle_deg, 1)]
             : [...row, `${text('report.none.figures')}: ${failure ?? ''}`];
  }));
  const wide: Node[] = [];
  if (plot) wide.push(section('report.plot', element('img', { class: 'plot', src: 'data:image/svg+xml;base64,' + plot, alt: text('report.plot') })));
  wide.push(section('report.cases', table('report.cases', ['table.tooth', 'report.by', 'report.trueLength', 'report.gotLength', 'report.apexOff', 'report.chamfer', 'report.fscore', 'report.hausdorff', 'report.angle'], single)));
  const beside: Node[] = [
    section('report.means', table('report.means', ['report.type', 'report.by', 'report.teeth', ...figures.map(([key]) => key)], [...all, ...types])),
    ...(held.length > 0 ? [section('report.coverage', element('ul', { class: 'notes' }, ...held.map((words) => element('li', {}, words))))] : []),
    ...notes([report.scanner_limits]), provenance(report, models),
  ];
  return { wide, beside };
}
