// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import { api, type Arch, type Interval, type Job, type Tooth } from './api';
import { correction, missingButton, type CorrectionActions } from './correction';
import { element } from './dom';
import { firstSettings, isSteered, quadrants, type Settings } from './settings';
import { number, text, type TextKey } from './texts';

export interface PanelActions extends CorrectionActions {
  steerTo(settings: Settings): void;   // while a slider moves; `change` follows when it is let go
  reset(): void;
  show(fdi: number, shown: boolean): void;
  isShown(fdi: number): boolean;
}

export interface PanelState {
  settings: Settings;
  job: Job | null;
  interval: Interval | null;  // of the root as predicted
  predicted: number | null;   // mm, its length
}

function section(name: TextKey, ...children: (Node | string)[]): HTMLElement {
  const id = 'section-' + name.replace('.', '-');
  return element('section', { 'aria-labelledby': id }, element('h2', { id }, text(name)), ...children);
}

function chart(state: PanelState, actions: PanelActions): HTMLElement {
  const { settings, job } = state;
  const arch = job?.arch;
  const group = element('div', { role: 'group', 'aria-label': text(arch ? 'chart.arch' : 'chart.label') });
  const button = (fdi: number): HTMLElement => {
    const label = text('tooth', { fdi });
    if (arch) {
      const isThere = arch.teeth.some((tooth) => tooth.fdi === fdi);
      return element('button', {
        type: 'button', 'aria-label': label, 'aria-pressed': String(isThere && actions.isShown(fdi)), disabled: !isThere,
        click: (event) => {
          const shown = !actions.isShown(fdi);
          actions.show(fdi, shown);
          (event.currentTarget as HTMLElement).setAttribute('aria-pressed', String(shown));
        },
      }, String(fdi));
    }
    return element('button', {
      type: 'button', 'aria-label': label, 'aria-pressed': String(settings.fdi === fdi), 'aria-current': settings.fdi === null && job?.tooth?.fdi === fdi ? 'true' : false, 'data-focus': `fdi-${fdi}`,
      click: () => actions.change({ ...settings, fdi, steering: {} }),
    }, String(fdi));
  };
  for (const jaw of ['upper', 'lower'] as const) {
    const rows = element('div', { class: 'chart', role: 'group', 'aria-label': text(`chart.${jaw}`) });
    for (const row of quadrants[jaw]) rows.append(...row.map(button));
    group.append(rows);
  }
  if (!arch)
    group.append(element('button', {
      type: 'button', 'aria-pressed': String(settings.fdi === null), 'data-focus': 'fdi-guess',
      click: () => actions.change({ ...settings, fdi: null, steering: {} }),
    }, text('chart.guess')));
  return section('section.tooth', group);
}

interface Slider { label: TextKey; low: number; high: number; step: number; unit: string; value: number; focus: string; set(value: number, final: boolean): void }

/** A slider with a box for the same number. */
function slider(s: Slider): HTMLElement {
  const digits = s.step < 0.1 ? 2 : s.step < 1 ? 1 : 0;
  const shown = s.value.toFixed(digits);
  const range = element('input', { type: 'range', min: s.low, max: s.high, step: s.step, value: shown, 'aria-label': text(s.label), 'data-focus': s.focus });
  const box = element('input', { type: 'number', min: s.low, max: s.high, step: s.step, value: shown, 'aria-label': `${text(s.label)}, ${s.unit}`, 'data-focus': s.focus + '-box' });
  const follow = (from: HTMLInputElement, to: HTMLInputElement, final: boolean): void => {
    const value = Number(from.value);
    if (from.value === '' || !Number.isFinite(value)) return;
    const bounded = Math.min(s.high, Math.max(s.low, value));
    to.value = bounded.toFixed(digits);
    if (final) from.value = bounded.toFixed(digits);
    s.set(bounded, final);
  };
  range.addEventListener('input', () => follow(range, box, false));
  range.addEventListener('change', () => follow(range, box, true));
  box.addEventListener('change', () => follow(box, range, true));
  return element('div', { class: 'field' }, element('span', {}, text(s.label)), element('span', {}, box, ' ' + s.unit), range);
}

function rootSection(state: PanelState, actions: PanelActions): HTMLElement {
  const { settings, job } = state;
  if (settings.kind === 'arch') return section('section.root', element('p', {}, text('root.arch')));
  const { steering } = settings;
  const set = (change: Partial<Settings['steering']>, final: boolean): void => {
    const next = { ...settings, steering: { ...steering, ...change } };
    if (final) actions.change(next);
    else actions.steerTo(next);
  };
  const length = steering.root_length_mm ?? job?.tooth?.root_length_mm ?? state.predicted ?? 12;
  return section(
    'section.root',
    slider({ label: 'root.length', low: 3, high: 30, step: 0.1, unit: 'mm', value: length, focus: 'length', set: (v, f) => set({ root_length_mm: v }, f) }),
    slider({ label: 'root.tip', low: -30, high: 30, step: 1, unit: '°', value: steering.tip_degrees ?? 0, focus: 'tip', set: (v, f) => set({ tip_degrees: v }, f) }),
    slider({ label: 'root.torque', low: -30, high: 30, step: 1, unit: '°', value: steering.torque_degrees ?? 0, focus: 'torque', set: (v, f) => set({ torque_degrees: v }, f) }),
    slider({ label: 'root.bend', low: -45, high: 45, step: 1, unit: '°', value: steering.bend_degrees ?? 0, focus: 'bend', set: (v, f) => set({ bend_degrees: v }, f) }),
    element('p', { id: 'working', role: 'status' }),
    element('div', { class: 'buttons' },
            element('button', { type: 'button', id: 'undo', 'data-focus': 'undo', disabled: !actions.canUndo(), click: () => actions.undo() }, text('root.undo')),
            element('button', { type: 'button', id: 'reset', 'data-focus': 'reset', disabled: !isSteered(steering), click: () => actions.reset() }, text('root.reset'))));
}

function choice(label: TextKey, focus: string, value: string, choices: [string, string][], set: (value: string) => void): HTMLElement {
  const select = element('select', { 'data-focus': focus, change: (event) => set((event.currentTarget as HTMLSelectElement).value) },
                         ...choices.map(([word, name]) => element('option', { value: word, selected: word === value }, name)));
  return element('label', { class: 'field' }, element('span', {}, text(label)), select);
}

function check(label: TextKey, focus: string, value: boolean, set: (value: boolean) => void): HTMLElement {
  const box = element('input', { type: 'checkbox', 'data-focus': focus, checked: value, change: (event) => set((event.currentTarget as HTMLInputElement).checked) });
  return element('label', { class: 'check' }, box, text(label));
}

function crownSection(state: PanelState, actions: PanelActions): HTMLElement {
  const { settings } = state;
  const change = (part: Partial<Settings>): void => actions.change({ ...settings, ...part });
  const made = section(
    'section.crown',
    choice('option.kind', 'kind', settings.kind, [['tooth', text('kind.tooth')], ['arch', text('kind.arch')]],
           (kind) => actions.change({ ...firstSettings(kind === 'arch' ? 'arch' : 'tooth'), unit: settings.unit, e: settings.e })),
    slider({ label: 'option.e', low: 0.2, high: 2, step: 0.05, unit: 'mm', value: settings.e, focus: 'e', set: (e, final) => { if (final) change({ e }); } }),
    choice('option.skirt', 'skirt', settings.skirt, [['keep', text('skirt.keep')], ['drop', text('skirt.auto')]],
           (skirt) => change({ skirt: skirt === 'drop' ? 'drop' : 'keep' })));
  if (settings.skirt === 'drop')
    made.append(slider({ label: 'option.threshold', low: 0.05, high: 0.95, step: 0.05, unit: '', value: settings.threshold, focus: 'threshold',
                         set: (threshold, final) => { if (final) change({ threshold }); } }));
  made.append(check('option.repair', 'repair', settings.repair, (repair) => change({ repair })),
              check('option.cap', 'cap', settings.dropCap, (dropCap) => change({ dropCap })));
  if (settings.kind === 'arch') made.append(check('option.resolve', 'resolve', settings.resolve, (resolve) => change({ resolve })));
  made.append(choice('option.unit', 'unit', String(settings.unit), [['1', 'mm'], ['10', 'cm'], ['1000', 'm'], ['0.001', 'µm'], ['25.4', 'inch']],
                     (unit) => change({ unit: Number(unit) })));
  return made;
}

function intervalText(interval: Interval | null): string {
  return interval ? `${number(interval.length_low_mm, 1)} – ${number(interval.length_high_mm, 1)}` : '–';
}

function notes(sentences: string[]): Node[] {
  if (sentences.length === 0) return [];
  const list = element('ul', { class: 'notes', lang: 'en' }, ...sentences.map((sentence) => element('li', {}, sentence)));
  return [element('details', { open: true }, element('summary', {}, `${text('fact.warnings')} (${sentences.length})`), list)];
}

function toothFacts(tooth: Tooth, state: PanelState): Node[] {
  const isSet = tooth.options.steering.root_length_mm !== null;
  const facts: [TextKey, string][] = [
    ['fact.tooth', `${tooth.fdi}${tooth.fdi_guessed ? ` (${text('fact.guessed')})` : ''}`],
    ['fact.kept', text('fact.of', { kept: number(tooth.kept_triangles, 0), all: number(tooth.crown_triangles, 0) })],
    ['fact.root', `${number(tooth.root_length_mm, 1)} mm${isSet ? ` (${text('fact.set')})` : ''}`],
    ['fact.interval', `${intervalText(tooth.interval ?? state.interval)} mm`],
    ['fact.quality', number(tooth.new_triangles_q_avg, 3)],
  ];
  if (tooth.crown_holds && tooth.solid_holds) facts.push(['fact.proved', text('fact.proved.yes')]);
  const list = element('dl', { id: 'facts' });
  for (const [name, value] of facts) list.append(element('dt', {}, text(name)), element('dd', {}, value));
  return [list, ...notes(tooth.warnings)];
}

function clearanceOf(arch: Arch, fdi: number): number | null {
  const found = arch.clearances.filter((c) => c.teeth.includes(fdi)).map((c) => c.of_roots_mm);
  return found.length > 0 ? Math.min(...found) : null;
}

function archTable(arch: Arch, state: PanelState, actions: PanelActions): Node[] {
  const lengths = new Map<number, HTMLInputElement>();
  const head = (['table.tooth', 'table.kept', 'table.root', 'table.interval', 'table.clearance', 'table.measured'] as TextKey[]).map(
    (key) => element('th', { scope: 'col' }, text(key)));
  head.push(element('th', { scope: 'col' }, element('span', { class: 'hidden' }, text('correct.missing'))));
  const rows = arch.teeth.map(({ fdi, tooth, refusal }) => {
    const found = arch.found.find((each) => each.fdi === fdi);
    const percent = found ? number(100 * found.confidence, 0) : '';
    const row = element('tr', {}, element('th', { scope: 'row', title: found ? text('table.found', { percent }) : '' }, String(fdi),
                                          ...(found ? [element('small', {}, ` ${percent} %`)] : [])));
    if (!tooth) {
      row.append(element('td', { class: 'why', colspan: 5 }, text('table.none') + ': ', element('span', { lang: 'en' }, refusal ?? '')),
                 element('td', {}, missingButton(fdi, arch, state.settings, actions)));
      return row;
    }
    const clearance = clearanceOf(arch, fdi);
    const measured = state.settings.lengths[String(fdi)];
    const box = element('input', { type: 'number', min: 3, max: 30, step: 0.1, 'aria-label': `${text('tooth', { fdi })}: ${text('root.typed')}`, value: measured ?? '' });
    lengths.set(fdi, box);
    row.append(element('td', {}, `${number(tooth.kept_triangles, 0)} / ${number(tooth.crown_triangles, 0)}`), element('td', {}, number(tooth.root_length_mm, 1)),
               element('td', {}, intervalText(tooth.interval)), element('td', {}, clearance === null ? '–' : number(clearance, 2)), element('td', {}, box));
    row.append(element('td', {}, missingButton(fdi, arch, state.settings, actions)));
    return row;
  });
  const apply = (): void => {
    const typed: Record<string, number> = {};
    for (const [fdi, box] of lengths) if (box.value !== '') typed[String(fdi)] = Number(box.value);
    actions.change({ ...state.settings, lengths: typed });
  };
  const table = element('table', {}, element('caption', { class: 'hidden' }, text('table.caption')), element('thead', {}, element('tr', {}, ...head)),
                        element('tbody', {}, ...rows));
  const sentences = arch.teeth.flatMap(({ fdi, tooth }) => (tooth?.warnings ?? []).map((sentence) => `${fdi}: ${sentence}`));
  return [
    element('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': text('table.caption') }, table),
    element('div', { class: 'buttons' }, element('button', { type: 'button', click: apply }, text('table.apply'))), correction(arch, state.settings, actions), ...notes([...arch.notes, ...sentences]),
  ];
}

function fileLinks(job: Job): HTMLElement {
  const stem = job.tooth ? `tooth_${job.tooth.fdi}` : 'arch';
  const link = (name: string, label: string, saved: string): HTMLElement => element('a', { href: api.fileUrl(job.job, name), download: saved }, label);
  const mesh = (name: string, ending: string): HTMLElement => job.formats?.includes(ending) ?? true
    ? link(`${name}.${ending}`, ending.toUpperCase(), `${stem}.${ending}`)
    : element('button', { type: 'button', disabled: true, title: text('files.single') }, ending.toUpperCase());
  const links = job.tooth
    ? ['ply', 'stl', 'obj', 'glb'].map((ending) => mesh('tooth', ending)).concat(
        link('report.html', text('files.report'), stem + '.html'), link('report.json', text('files.json'), stem + '.json'))
    : [link('report.html', text('files.report'), 'arch.html'), ...(job.formats?.length === 0 ? [] : ['ply', 'stl', 'obj'].map((ending) => mesh('arch', ending))), link('arch.glb', 'GLB', 'arch.glb'), link('arch.json', text('files.json'), 'arch.json')];
  return section('section.files', element('div', { class: 'buttons' }, ...links, link('all.zip', text('files.all'), stem + '.zip')));
}

/** Puts the figures of a newer root in place of the older ones and leaves the rest, such as a slider at work, alone. */
export function refillFacts(panel: HTMLElement, state: PanelState): void {
  const old = panel.querySelector('#facts')?.closest('section');
  if (state.job?.tooth) old?.replaceWith(section('section.results', ...toothFacts(state.job.tooth, state)));
}

/** Fills the panel anew; what had the focus has it again. */
export function fillPanel(panel: HTMLElement, state: PanelState, actions: PanelActions): void {
  const focused = (document.activeElement as HTMLElement | null)?.dataset.focus;
  const { job } = state;
  const parts: Node[] = [];
  panel.classList.toggle('wide', job?.arch !== undefined);
  if (job?.tooth) parts.push(section('section.results', ...toothFacts(job.tooth, state)));
  if (job?.arch) parts.push(section('section.results', ...archTable(job.arch, state, actions)));
  if (job?.tooth) parts.push(rootSection(state, actions));
  if (job?.state === 'done') parts.push(fileLinks(job));
  parts.push(chart(state, actions), crownSection(state, actions));
  panel.replaceChildren(...parts);
  if (focused) panel.querySelector<HTMLElement>(`[data-focus="${focused}"]`)?.focus({ preventScroll: true });
}
