// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import { colourings, fillLegend, type Colouring } from './colours';
import { byId, element } from './dom';
import { text, type TextKey } from './texts';
import type { Side, Viewer } from './viewer';

export type Switch = 'wireframe' | 'seethrough' | 'ghosts' | 'gum' | 'clip' | 'measure';

const sides: [Side, string][] = [['front', '1'], ['back', '2'], ['left', '3'], ['right', '4'], ['top', '5'], ['bottom', '6']];
const switches: [Switch, string][] = [['wireframe', 'W'], ['seethrough', 'X'], ['ghosts', 'G'], ['clip', 'C'], ['measure', 'M'], ['gum', 'U']];

/** What stands above the view: colours, directions, switches; and their keys. */
export class ViewBar {
  private readonly on = new Set<Switch>(['gum']);
  private readonly colouring = byId<HTMLSelectElement>('colouring');
  private readonly clip = byId<HTMLInputElement>('clip');
  private readonly legend = byId('legend');

  /** @param without  switches that are of no use where the bar is */
  constructor(private readonly viewer: Viewer, private readonly flipped: (name: Switch, on: boolean) => void,
              private readonly without: Switch[] = []) {
    this.colouring.addEventListener('change', () => this.applyColouring());
    this.clip.addEventListener('input', () => this.applyClip());
    document.addEventListener('keydown', (event) => this.key(event));
  }

  get chosen(): Colouring {
    return (this.colouring.value || 'source') as Colouring;
  }

  isOn(name: Switch): boolean {
    return this.on.has(name);
  }

  /** Texts anew, and only what the meshes allow. */
  fill(isArch: boolean): void {
    const chosen = this.viewer.has(this.chosen) ? this.chosen : 'source';
    this.colouring.replaceChildren(...colourings.map((name) => {
      const there = this.viewer.has(name);
      const reason = there ? '' : name === 'clearance' ? text('colour.none.clearance') : name === 'confidence' ? text('colour.none.confidence') : '';
      return element('option', { value: name, disabled: !there, selected: name === chosen, title: reason }, text(`colour.${name}`));
    }));
    byId('views').replaceChildren(
      ...sides.map(([side, key]) => this.button(`view.${side}`, key, () => this.viewer.view(side))),
      this.button('view.fit', '0', () => this.viewer.fit()));
    byId('switches').replaceChildren(...switches.filter(([name]) => name !== (isArch ? 'ghosts' : 'gum') && !this.without.includes(name)).map(([name, key]) => {
      const made = this.button(`view.${name}`, key, () => this.flip(name));
      made.dataset.switch = name;
      made.setAttribute('aria-pressed', String(this.isOn(name)));
      return made;
    }));
    this.applyColouring();
  }

  flip(name: Switch): void {
    const button = document.querySelector<HTMLElement>(`[data-switch="${name}"]`);
    if (!button) return;
    const on = !this.isOn(name);
    if (on) this.on.add(name);
    else this.on.delete(name);
    button.setAttribute('aria-pressed', String(on));
    if (name === 'wireframe') this.viewer.setWireframe(on);
    if (name === 'seethrough') this.viewer.setSeeThrough(on);
    if (name === 'gum') this.viewer.showGum(on);
    if (name === 'clip') this.applyClip();
    this.flipped(name, on);
  }

  private button(key: TextKey, shortcut: string, act: () => void): HTMLButtonElement {
    return element('button', { type: 'button', title: `${text(key)} (${shortcut})`, 'aria-keyshortcuts': shortcut, click: act }, text(key));
  }

  private applyColouring(): void {
    this.viewer.setColouring(this.chosen);
    fillLegend(this.legend, this.chosen);
    this.legend.dataset.colouring = this.chosen;
  }

  private applyClip(): void {
    byId('clip-label').hidden = !this.isOn('clip');
    this.viewer.setClip(this.isOn('clip') ? Number(this.clip.value) / 100 : null);
  }

  private key(event: KeyboardEvent): void {
    const { target } = event;
    if (event.ctrlKey || event.metaKey || event.altKey || byId('bar').hidden) return;
    if (target instanceof HTMLInputElement || target instanceof HTMLSelectElement) return;
    const side = sides.find(([, key]) => key === event.key);
    const flipped = switches.find(([, key]) => key === event.key.toUpperCase());
    const step = Math.PI / 24;
    const isOnView = target === byId('view');
    if (side) this.viewer.view(side[0]);
    else if (flipped) this.flip(flipped[0]);
    else if (event.key === '0') this.viewer.fit();
    else if (event.key === '+' || event.key === '=') this.viewer.zoom(0.87);
    else if (event.key === '-') this.viewer.zoom(1.15);
    else if (isOnView && event.key === 'ArrowLeft') this.viewer.turn(-step, 0);
    else if (isOnView && event.key === 'ArrowRight') this.viewer.turn(step, 0);
    else if (isOnView && event.key === 'ArrowUp') this.viewer.turn(0, -step);
    else if (isOnView && event.key === 'ArrowDown') this.viewer.turn(0, step);
    else return;
    event.preventDefault();
  }
}
