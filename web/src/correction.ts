// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import type { Arch, Correction } from './api';
import { element } from './dom';
import { quadrants, type Settings } from './settings';
import { text } from './texts';

export interface CorrectionActions {
  change(settings: Settings): void;  // all at once, such as a number or an option
  undo(): void;
  canUndo(): boolean;
  /** The next point that is chosen in the view is for these settings. */
  point(words: string, settings: (at: [number, number, number]) => Settings): void;
}

function corrected(settings: Settings, next: Correction): Settings {
  return { ...settings, corrections: [...settings.corrections, next] };
}

/** A tooth that is none: where the teeth were searched for, the others are read anew without it. */
export function missingButton(fdi: number, arch: Arch, settings: Settings, actions: CorrectionActions): HTMLElement {
  const click = (): void => {
    if (!arch.searched) return actions.change(corrected(settings, { remove: fdi }));
    const places = Object.fromEntries(Object.entries(settings.places).filter(([key]) => key !== String(fdi)));
    actions.change({ ...settings, missing: [...settings.missing, fdi], places });
  };
  return element('button', {
    type: 'button', class: 'small', 'aria-label': `${text('tooth', { fdi })}: ${text('correct.missing')}`, title: text('correct.missing'), click,
  }, '✕');
}

/** The tooth that is pointed at gets a number; where the teeth were searched for, the others are read anew with it. */
function numbered(fdi: number, arch: Arch, settings: Settings): (at: [number, number, number]) => Settings {
  return (at) => arch.searched
    ? { ...settings, places: { ...settings.places, [String(fdi)]: at }, missing: settings.missing.filter((other) => other !== fdi) }
    : corrected(settings, { number: fdi, at });
}

function words(correction: Correction): string {
  if ('number' in correction) return text('correct.placed', { fdi: correction.number });
  if ('split' in correction) return text('correct.divided', { fdi: correction.split });
  if ('remove' in correction) return text('correct.gone', { fdi: correction.remove });
  return text('correct.merged', { fdi: correction.merge[0], other: correction.merge[1] });
}

function choice(label: string, focus: string, teeth: number[], chosen?: number): HTMLSelectElement {
  return element('select', { 'aria-label': label, 'data-focus': focus },
                 ...teeth.map((fdi) => element('option', { value: fdi, selected: fdi === chosen }, text('tooth', { fdi }))));
}

/** What a person may say of a scan's teeth: which number one has, that one is two, that two are one. */
export function correction(arch: Arch, settings: Settings, actions: CorrectionActions): HTMLElement {
  const there = arch.teeth.map((tooth) => tooth.fdi);
  const all = [...quadrants.upper, ...quadrants.lower].flat();
  const isUpper = (fdi: number): boolean => fdi % 40 < 30 && (fdi < 30 || fdi > 50);  // 11 to 28, 51 to 65
  const jaw = all.filter((fdi) => there.some((other) => isUpper(other) === isUpper(fdi)));
  const select = choice(text('correct.number'), 'correct', jaw.length > 0 ? jaw : all);
  const part = choice(text('correct.part'), 'correct-part', there, there[1]);
  const whole = choice(text('correct.whole'), 'correct-whole', there, there[0]);
  const button = (label: string, click: () => void, disabled = false): HTMLElement => element('button', { type: 'button', disabled, click }, label);
  const done = [...Object.keys(settings.places).map((fdi) => text('correct.placed', { fdi })),
                ...settings.missing.map((fdi) => text('correct.gone', { fdi })), ...settings.corrections.map(words)];
  return element('div', { class: 'correct' }, element('h3', {}, text('correct.title')), element('p', {}, text('correct.how')),
                 element('div', { class: 'buttons' }, select,
                         button(text('correct.choose'), () => actions.point(text('correct.place', { fdi: select.value }), numbered(Number(select.value), arch, settings))),
                         button(text('correct.divide'), () => actions.point(text('correct.meet', { fdi: select.value }),
                                                                              (at) => corrected(settings, { split: Number(select.value), at })))),
                 element('div', { class: 'buttons' }, part, element('span', {}, text('correct.whole')), whole,
                         button(text('correct.merge'), () => actions.change(corrected(settings, { merge: [Number(whole.value), Number(part.value)] })), there.length < 2)),
                 element('div', { class: 'buttons' }, button(text('root.undo'), () => actions.undo(), !actions.canUndo())),
                 ...(done.length > 0 ? [element('p', { class: 'done' }, done.join(', '))] : []));
}
