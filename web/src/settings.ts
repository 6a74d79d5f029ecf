// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import type { Correction, JobRequest, Options, Steering } from './api';

/** FDI numbers as charts have them. */
export const quadrants = { upper: [[18, 17, 16, 15, 14, 13, 12, 11], [21, 22, 23, 24, 25, 26, 27, 28]], lower: [[48, 47, 46, 45, 44, 43, 42, 41], [31, 32, 33, 34, 35, 36, 37, 38]] };

export type Kind = 'tooth' | 'arch';

/** All that a user may set; plain, so that undo keeps copies. */
export interface Settings {
  kind: Kind;
  fdi: number | null;  // null: by the file's name, else by shape
  e: number;           // mm
  skirt: 'keep' | 'drop';
  threshold: number;   // of confidence, where the skirt is dropped
  repair: boolean;
  dropCap: boolean;
  unit: number;        // mm
  resolve: boolean;
  steering: Steering;
  lengths: Record<string, number>;  // measured, by FDI number
  missing: number[];                // of a scan whose teeth were searched for: those that are not there
  places: Record<string, [number, number, number]>;  // and places on teeth, in the scan's unit
  corrections: Correction[];        // of the labels, one after the other
}

export function firstSettings(kind: Kind): Settings {
  const isArch = kind === 'arch';  // crowns cut from a scan need both
  return {
    kind, fdi: null, e: 0.5, skirt: isArch ? 'drop' : 'keep', threshold: 0.5, repair: isArch, dropCap: true, unit: 1, resolve: false,
    steering: {}, lengths: {}, missing: [], places: {}, corrections: [],
  };
}

export function isSteered(steering: Steering): boolean {
  return steering.root_length_mm != null || !!steering.tip_degrees || !!steering.torque_degrees || !!steering.bend_degrees;
}

export function requestOf(scan: string, settings: Settings): JobRequest {
  const options: Options = {
    e_mm: settings.e,
    repair: settings.repair,
    skirt: settings.skirt === 'keep' ? 'keep' : settings.threshold,
    cap: settings.dropCap ? 'drop' : 'keep',
    millimetres_per_unit: settings.unit,
  };
  if (settings.kind === 'arch')
    return {
      scan, kind: 'arch', options, root_lengths_mm: settings.lengths, resolve_collisions: settings.resolve, missing: settings.missing,
      teeth: settings.places, corrections: settings.corrections,
    };
  if (settings.fdi !== null) options.fdi = settings.fdi;
  if (isSteered(settings.steering)) options.steering = settings.steering;
  return { scan, kind: 'tooth', options };
}

/** True if the two differ in the root's steering alone, which needs the second half of the work only. */
export function differInSteeringAlone(a: Settings, b: Settings): boolean {
  const without = (s: Settings): string => JSON.stringify({ ...s, steering: {} });
  return a.kind === 'tooth' && without(a) === without(b);
}

/** What was before, to go back to. */
export class History {
  private readonly before: Settings[] = [];

  push(settings: Settings): void {
    this.before.push(structuredClone(settings));
  }

  pop(): Settings | undefined {
    return this.before.pop();
  }

  clear(): void {
    this.before.length = 0;
  }

  get isEmpty(): boolean {
    return this.before.length === 0;
  }
}
