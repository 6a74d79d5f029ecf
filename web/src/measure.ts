// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import type { Vector3 } from 'three';

import type { Picker } from './picker';
import { number, text } from './texts';
import type { Viewer } from './viewer';

/** Distances between two points of what is shown. */
export class MeasureTool {
  private points: Vector3[] = [];

  constructor(private readonly viewer: Viewer, private readonly canvas: HTMLCanvasElement, private readonly picker: Picker,
              private readonly say: (words: string | null) => void) {}

  set(on: boolean): void {
    this.points = [];
    this.viewer.setMarks([]);
    this.picker.ask(on ? (point) => this.place(point) : null);
    this.say(on ? text('measure.first') : null);
  }

  private place(point: Vector3): void {
    this.points = this.points.length === 2 ? [point] : [...this.points, point];
    this.viewer.setMarks(this.points);
    const [first, second] = this.points;
    this.say(first && second ? text('measure.result', { mm: number(first.distanceTo(second), 2) }) : text('measure.second'));
    this.canvas.dataset.measured = first && second ? String(first.distanceTo(second)) : '';
  }
}
