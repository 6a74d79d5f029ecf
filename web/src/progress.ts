// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import { api, type Job } from './api';
import { byId, element } from './dom';
import { isTextKey, text, type TextKey } from './texts';

/** What is said while a job is at work: its stages, as they happen. */
export class Progress {
  private readonly box = byId('progress');
  private readonly stages = byId('stages');
  private readonly now = byId('progress-now');

  begin(): void {
    this.stages.replaceChildren();
    this.box.hidden = false;
  }

  end(): void {
    this.box.hidden = true;
    this.now.textContent = '';
  }

  say(key: TextKey, values: Record<string, string | number> = {}): void {
    this.now.textContent = text(key, values);
  }

  stage(name: string): void {
    const key = 'stage.' + name;
    const words = isTextKey(key) ? text(key) : name;
    for (const item of this.stages.querySelectorAll('.now')) item.classList.remove('now');
    this.stages.append(element('li', { class: 'now' }, words));
    this.now.textContent = words;
  }
}

/** Follows a job to its end; null if the program is gone or does not know it. */
export function follow(id: string, progress: Progress): Promise<Job | null> {
  return new Promise((resolve) => {
    const source = api.events(id);
    let failures = 0;
    const finish = (): void => {
      source.close();
      api.job(id).then(resolve, () => resolve(null));
    };
    source.addEventListener('open', () => { failures = 0; });
    source.addEventListener('stage', (event) => progress.stage((JSON.parse((event as MessageEvent<string>).data) as { stage: string }).stage));
    source.addEventListener('tooth', (event) =>
      progress.say('progress.tooth', JSON.parse((event as MessageEvent<string>).data) as { done: number; teeth: number }));
    source.addEventListener('end', finish);
    source.addEventListener('error', () => {  // a stream that was closed is opened again by the browser itself
      if (source.readyState === EventSource.CLOSED || ++failures > 5) finish();
    });
  });
}
