// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import './style.css';

import { byId, element, fillTexts } from './dom';
import { MeasureTool } from './measure';
import { Picker } from './picker';
import { archParts, type ArchReport } from './report_arch';
import { evaluationParts, type EvaluationReport } from './report_evaluation';
import { toothParts, type ToothReport } from './report_tooth';
import { language, languages, setLanguage, text, type Language, type TextKey } from './texts';
import { followTheme } from './theme';
import { readViewMesh, type ViewMesh } from './view_mesh';
import { ViewBar } from './view_bar';
import { vector, Viewer } from './viewer';

// The report of the command line as a page by itself: the JSON and the meshes to look at stand in it.

type Report = ToothReport | ArchReport | EvaluationReport;
interface Data { report: Report; views: Record<string, string>; models: Record<string, string>; plot?: string }

const data = JSON.parse(byId('rhizodont-report').textContent ?? '{}') as Data;
const { report } = data;

function isArch(given: Report): given is ArchReport {
  return 'arch_report_version' in given;
}

function isEvaluation(given: Report): given is EvaluationReport {
  return 'evaluation' in given;
}

function mesh(name: string): ViewMesh | undefined {
  const base64 = data.views[name];
  if (base64 === undefined) return undefined;
  const binary = atob(base64);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return readViewMesh(bytes.buffer);
}

const viewer = new Viewer(byId<HTMLCanvasElement>('view'));
const hint = (words: string | null): void => {
  byId('hint').hidden = words === null;
  byId('hint').textContent = words ?? '';
};
const measure = new MeasureTool(viewer, byId<HTMLCanvasElement>('view'), new Picker(viewer, byId<HTMLCanvasElement>('view'), byId('cross')), hint);
const bar = new ViewBar(viewer, (name, on) => { if (name === 'measure') measure.set(on); }, ['ghosts']);
const tooth = mesh('tooth');

function title(): TextKey {
  if (isArch(report)) return 'report.arch';
  if (isEvaluation(report)) return 'report.evaluation';
  return report.refused ? 'report.refused' : 'report.title';
}

function write(): void {
  document.documentElement.lang = language();
  fillTexts();
  document.querySelector('.subtitle')?.replaceChildren(text(title()));
  document.title = `Rhizodont: ${text(title())}`;
  byId('language').replaceChildren(...languages().map(([code, name]) => element('option', { value: code, selected: code === language() }, name)));
  if (isEvaluation(report)) {
    const { wide, beside } = evaluationParts(report, data.models, data.plot);
    byId('area').replaceChildren(element('div', { class: 'figures' }, ...wide));
    byId('panel').replaceChildren(...beside);
  } else if (isArch(report)) {
    byId('panel').replaceChildren(...archParts(report, data.models, viewer));
  } else {
    byId('panel').replaceChildren(...toothParts(report, data.models, tooth));
  }
  if (!byId('bar').hidden) bar.fill(isArch(report));
}

function showTooth(of: ToothReport): void {
  const crown = mesh('crown');
  if (!tooth || !crown) return;
  viewer.setTooth(of.fdi?.number ?? 0, tooth, crown);
  const rotation = of.frame?.rotation;
  if (rotation) viewer.setDirections({ up: vector(rotation[2] ?? [0, 0, 1]), front: vector(rotation[1] ?? [0, 1, 0]) });
  byId('bar').hidden = byId('legend').hidden = false;
}

function showArch(of: ArchReport): void {
  for (const { fdi } of of.teeth) {
    const crown = mesh(`crown-${fdi}`);
    if (crown) viewer.setTooth(fdi, mesh(`tooth-${fdi}`) ?? crown, crown);  // without a root, what was scanned
  }
  viewer.setGum(mesh('gum') ?? null);
  if (of.upright) viewer.setDirections({ up: vector(of.upright[1] ?? [0, 0, 1]), front: vector(of.upright[2] ?? [0, 1, 0]) });
  byId('bar').hidden = byId('legend').hidden = false;
}

if (isArch(report)) showArch(report);
else if (!isEvaluation(report)) showTooth(report);
byId('panel').classList.toggle('wide', isArch(report) || isEvaluation(report));
write();
if (!isEvaluation(report)) viewer.view('front');
followTheme(byId('theme'));
byId('language').addEventListener('change', (event) => {
  setLanguage((event.currentTarget as HTMLSelectElement).value as Language);
  write();
});
