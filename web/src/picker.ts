// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import type { Vector3 } from 'three';

import type { Viewer } from './viewer';

/** Points of what is shown that a user chooses: by clicks, or by Enter at the middle of the view. */
export class Picker {
  private wanted: ((point: Vector3) => void) | null = null;
  private ofScan = false;
  private pressed: { x: number; y: number } | null = null;

  constructor(private readonly viewer: Viewer, canvas: HTMLCanvasElement, private readonly cross: HTMLElement) {
    canvas.addEventListener('pointerdown', (event) => { this.pressed = { x: event.clientX, y: event.clientY }; });
    canvas.addEventListener('pointerup', (event) => {
      const { pressed } = this;
      if (!pressed || Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y) >= 5) return;  // that turned the view
      const box = canvas.getBoundingClientRect();
      this.pick((2 * (event.clientX - box.left)) / box.width - 1, 1 - (2 * (event.clientY - box.top)) / box.height);
    });
    canvas.addEventListener('keydown', (event) => {
      if (event.key === 'Enter') this.pick(0, 0);
    });
  }

  /** Whoever asked before gets no more points. null: nobody is to get any. */
  ask(wanted: ((point: Vector3) => void) | null, ofScan = false): void {
    this.wanted = wanted;
    this.ofScan = ofScan;
    this.cross.hidden = wanted === null;
  }

  private pick(x: number, y: number): void {
    const point = this.wanted && this.viewer.pick(x, y, this.ofScan);
    if (point) this.wanted?.(point);
  }
}
