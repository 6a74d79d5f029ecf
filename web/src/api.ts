// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/** The API of the program, /api/v1: docs/openapi.json. */
const root = '/api/v1';

export interface Sample { name: string; kind: 'tooth' | 'arch'; fdi: number | null; skirt: boolean }
export interface SentScan {
  scan: string; sha256: string; vertices: number; triangles: number; fdi_in_name: number | null; has_labels: boolean; kind: 'tooth' | 'arch'; notes: string[];
}
export interface Steering { root_length_mm?: number | null; tip_degrees?: number; torque_degrees?: number; bend_degrees?: number }
export interface Options {
  fdi?: number | null; e_mm?: number; skirt?: string | number | null; repair?: boolean; cap?: 'keep' | 'drop';
  millimetres_per_unit?: number; steering?: Steering;
}
export type Correction =
  | { number: number; at: Vector } | { split: number; at: Vector } | { merge: [number, number] } | { remove: number };
export interface JobRequest {
  scan: string; kind: 'tooth' | 'arch'; options: Options; root_lengths_mm?: Record<string, number>; resolve_collisions?: boolean; missing?: number[]; teeth?: Record<string, [number, number, number]>;
  corrections?: Correction[];
}
export interface Interval { length_low_mm: number; length_high_mm: number; apex_radius_mm: number }
export type Vector = [number, number, number];
export interface Tooth {
  fdi: number; fdi_guessed: boolean; crown_triangles: number; kept_triangles: number; crown_holds: boolean; solid_holds: boolean;
  triangles: number; new_triangles_q_avg: number; root_length_mm: number; tooth_length_mm: number; interval: Interval | null;
  repairs: number; directions: { occlusal: Vector; buccal: Vector; along_the_arch: Vector };
  options: { steering: { root_length_mm: number | null; tip_degrees: number; torque_degrees: number; bend_degrees: number } };
  warnings: string[];
}
export interface ToothOfArch { fdi: number; rooted: boolean; refusal: string | null; tooth: Tooth | null }
export interface FoundTooth { fdi: number; confidence: number; second: number | null; second_confidence: number }
export interface Arch {
  teeth: ToothOfArch[]; searched: boolean; found: FoundTooth[]; clearances: { teeth: [number, number]; of_roots_mm: number }[]; has_gum: boolean; upright: Vector[] | null;
  notes: string[];
}
export interface Refusal { kind: string; sentence: string; exit_code?: number; ids?: unknown[]; ids_in_all?: number }
export type State = 'waiting' | 'running' | 'done' | 'refused' | 'cancelled';
export interface Job {
  job: string; kind: 'tooth' | 'arch'; state: State; seconds: number; revision?: number; formats?: string[]; tooth?: Tooth; arch?: Arch; error?: Refusal;
}

/** What the program says of a request that it does not carry out. */
export class Refused extends Error {
  constructor(readonly status: number, readonly refusal: Refusal) {
    super(refusal.sentence);
  }
}

async function ask(path: string, init: RequestInit = {}): Promise<Response> {
  const response = await fetch(root + path, init);
  if (response.ok) return response;
  let refusal: Refusal = { kind: 'fault of the program', sentence: response.statusText || String(response.status) };
  try {
    refusal = ((await response.json()) as { error: Refusal }).error;
  } catch { /* no JSON: the status says what there is to say */ }
  throw new Refused(response.status, refusal);
}

async function askJson<T>(path: string, init: RequestInit = {}): Promise<T> {
  return (await ask(path, init)).json() as Promise<T>;
}

function sending(json: unknown): RequestInit {
  return { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify(json) };
}

export const api = {
  samples: () => askJson<{ samples: Sample[] }>('/samples').then((answer) => answer.samples),
  sample: (name: string) => ask('/samples/' + encodeURIComponent(name)).then((answer) => answer.blob()),
  sendScan: (bytes: Blob, name: string, signal: AbortSignal) =>
    askJson<SentScan>('/scans?name=' + encodeURIComponent(name),
                      { method: 'POST', headers: { 'Content-Type': 'application/octet-stream' }, body: bytes, signal }),
  sendLabels: (scan: string, labels: Blob, signal: AbortSignal) =>
    askJson<{ scan: string }>(`/scans/${scan}/labels`, { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: labels, signal }),
  start: (request: JobRequest) => askJson<{ job: string }>('/jobs', sending(request)).then((answer) => answer.job),
  job: (id: string) => askJson<Job>('/jobs/' + id),
  cancel: (id: string) => ask(`/jobs/${id}/cancel`, { method: 'POST', body: '' }),
  forget: (id: string) => ask('/jobs/' + id, { method: 'DELETE' }),
  forgetScan: (id: string) => ask('/scans/' + id, { method: 'DELETE' }),
  steer: (id: string, steering: Steering, signal: AbortSignal) =>
    askJson<{ revision: number; tooth: Tooth }>(`/jobs/${id}/steering`, { ...sending(steering), signal }),
  view: (id: string, name: string) => ask(`/jobs/${id}/views/${name}`).then((answer) => answer.arrayBuffer()),
  fileUrl: (id: string, name: string) => `${root}/jobs/${id}/files/${name}`,
  events: (id: string) => new EventSource(`${root}/jobs/${id}/events`),
};
