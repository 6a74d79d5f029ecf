// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import { number, text, type TextKey } from './texts';
import type { ViewMesh } from './view_mesh';

export type Colouring = 'source' | 'deviation' | 'quality' | 'uncertainty' | 'clearance' | 'confidence';
export const colourings: Colouring[] = ['source', 'deviation', 'quality', 'uncertainty', 'clearance', 'confidence'];

/** Which of the two meshes of a tooth a colouring is of: the tooth, or the crown as it was given. */
export function isOfCrown(colouring: Colouring): boolean {
  return colouring === 'deviation' || colouring === 'confidence';
}

type Colour = [number, number, number];  // sRGB, 0..1

function hex(code: number): Colour {
  return [((code >> 16) & 255) / 255, ((code >> 8) & 255) / 255, (code & 255) / 255];
}

// Distinct by lightness alone, too, for eyes that tell few hues apart.
const sources: Colour[] = [hex(0xf0e2c0), hex(0xe08a1e), hex(0x3f78b5)];
const unjudged: Colour = hex(0x9a9a9a);

// Few stops of perceptually even maps: dark to light (viridis), and from too near through near to far.
const even: Colour[] = [hex(0x440154), hex(0x3b528b), hex(0x21918c), hex(0x5ec962), hex(0xfde725)];
const signed: Colour[] = [hex(0x8e0152), hex(0xd6336c), hex(0xf7e08b), hex(0x7fbf7b), hex(0x1b7837)];

interface Scale { low: number; high: number; stops: Colour[]; digits: number }

const scales: Record<Exclude<Colouring, 'source'>, Scale> = {
  deviation: { low: 0, high: 0.1, stops: even, digits: 3 },
  quality: { low: 0.5, high: 1, stops: even, digits: 2 },
  uncertainty: { low: 0, high: 3, stops: even, digits: 1 },
  clearance: { low: -1, high: 3, stops: signed, digits: 1 },
  confidence: { low: 0, high: 1, stops: even, digits: 1 },
};

function onScale(scale: Scale, value: number): Colour {
  const share = Math.min(1, Math.max(0, (value - scale.low) / (scale.high - scale.low))) * (scale.stops.length - 1);
  const stop = Math.min(Math.floor(share), scale.stops.length - 2);
  const from = scale.stops[stop] as Colour;
  const to = scale.stops[stop + 1] as Colour;
  const part = share - stop;
  return [from[0] + part * (to[0] - from[0]), from[1] + part * (to[1] - from[1]), from[2] + part * (to[2] - from[2])];
}

function linear(share: number): number {
  return share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
}

function colourOf(colouring: Colouring, value: number): Colour {
  if (colouring === 'source') return sources[value] ?? unjudged;
  if (colouring === 'confidence' && value < 0) return unjudged;
  return onScale(scales[colouring], value);
}

export interface Colours { per: 'vertex' | 'triangle'; linear: Float32Array }

export function hasNumbers(mesh: ViewMesh, colouring: Colouring): boolean {
  return mesh.perVertex.has(colouring) || mesh.perTriangle.has(colouring);
}

/** Colours of a mesh; null if it has no such numbers. */
export function coloursOf(mesh: ViewMesh, colouring: Colouring): Colours | null {
  const perVertex = mesh.perVertex.get(colouring);
  const values = perVertex ?? mesh.perTriangle.get(colouring);
  if (!values) return null;
  const colours = new Float32Array(3 * values.length);
  const known = new Map<number, Colour>();
  for (let i = 0; i < values.length; ++i) {
    const value = values[i] as number;
    let colour = known.get(value);
    if (!colour) {
      colour = colourOf(colouring, value).map(linear) as Colour;
      if (known.size < 4096) known.set(value, colour);
    }
    colours.set(colour, 3 * i);
  }
  return { per: perVertex ? 'vertex' : 'triangle', linear: colours };
}

function css(colour: Colour): string {
  return `rgb(${colour.map((part) => Math.round(255 * part)).join(' ')})`;
}

/** Fills the legend for a colouring. */
export function fillLegend(legend: HTMLElement, colouring: Colouring): void {
  const make = (name: string, content = ''): HTMLElement => {
    const made = document.createElement('span');
    made.className = name;
    made.textContent = content;
    return made;
  };
  const swatch = (colour: Colour, words: string): HTMLElement => {
    const row = make('swatch', words);
    const square = make('square');
    square.style.backgroundColor = css(colour);
    row.prepend(square);
    return row;
  };
  if (colouring === 'source') {
    const names: TextKey[] = ['legend.source.scan', 'legend.source.transition', 'legend.source.predicted'];
    legend.replaceChildren(...names.map((name, i) => swatch(sources[i] as Colour, text(name))));
    return;
  }
  const scale = scales[colouring];
  const bar = make('bar');
  bar.style.backgroundImage = `linear-gradient(to right, ${scale.stops.map(css).join(', ')})`;
  const ticks = make('ticks');
  const middle = (scale.low + scale.high) / 2;
  ticks.replaceChildren(...[scale.low, middle, scale.high].map((tick) => make('tick', number(tick, scale.digits))));
  legend.replaceChildren(make('what', text(`legend.${colouring}`)), bar, ticks);
  if (colouring === 'confidence') legend.append(swatch(unjudged, text('legend.unjudged')));
}
