// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import './style.css';

import { api, Refused, type Interval, type Job, type Refusal, type Sample, type Steering, type Tooth } from './api';
import { byId, element, fillTexts } from './dom';
import { MeasureTool } from './measure';
import { Picker } from './picker';
import { fillPanel, refillFacts, type PanelActions, type PanelState } from './panel';
import { follow, Progress } from './progress';
import { differInSteeringAlone, firstSettings, History, isSteered, requestOf, type Settings } from './settings';
import { language, languages, setLanguage, text, type Language } from './texts';
import { followTheme } from './theme';
import { readViewMesh } from './view_mesh';
import { ViewBar, type Switch } from './view_bar';
import { vector, Viewer } from './viewer';

const kept = 'rhizodont.job';  // for a reload; ids alone, and only while the tab is open

interface Kept { scan: string; job: string; settings: Settings; interval: Interval | null; predicted: number | null }

/** The page: what is open, and what happens to it. */
class Page implements PanelActions {
  private readonly viewer = new Viewer(byId<HTMLCanvasElement>('view'));
  private readonly progress = new Progress();
  private readonly history = new History();
  private readonly bar = new ViewBar(this.viewer, (name, on) => this.flipped(name, on));
  private readonly picker = new Picker(this.viewer, byId<HTMLCanvasElement>('view'), byId('cross'));
  private readonly measure = new MeasureTool(this.viewer, byId<HTMLCanvasElement>('view'), this.picker, (words) => this.hint(words));
  private scan: string | null = null;
  private settings: Settings = firstSettings('tooth');
  private applied: Settings | null = null;  // what was last asked for
  private shown: Settings | null = null;    // what the tooth in view was made with
  private job: Job | null = null;
  private interval: Interval | null = null;
  private predicted: number | null = null;
  private centre: [number, number, number] = [0, 0, 0];  // mm: what coordinates of the view are counted from
  private running: string | null = null;
  private sending: AbortController | null = null;
  private wanted: Steering | null = null;
  private isSteering = false;
  private steeringNow = '';  // what is at work, as JSON
  private isMoving = false;  // a slider
  private asked = 0;         // counts what was opened or started: answers to older questions are passed over
  private samples: Sample[] = [];

  async begin(): Promise<void> {
    this.listen();
    this.write();
    try {
      this.samples = await api.samples();
      this.writeSamples();
      await this.reopen();
    } catch {
      this.say({ kind: 'gone', sentence: text('state.gone') });
    }
  }

  // --- what the panel asks for

  change(settings: Settings): void {
    this.isMoving = false;
    if (JSON.stringify(settings) === JSON.stringify(this.applied)) return;
    if (this.applied) this.history.push(this.applied);
    this.apply(settings);
  }

  steerTo(settings: Settings): void {
    this.isMoving = true;
    this.settings = settings;
    this.steer(settings.steering);
  }

  undo(): void {
    const before = this.history.pop();
    if (before) this.apply(before);
  }

  reset(): void {
    this.change({ ...this.settings, steering: {} });
  }

  canUndo(): boolean {
    return !this.history.isEmpty;
  }

  show(fdi: number, shown: boolean): void {
    this.viewer.show(fdi, shown);
  }

  isShown(fdi: number): boolean {
    return this.viewer.isShown(fdi);
  }

  point(words: string, settings: (at: [number, number, number]) => Settings): void {
    if (this.bar.isOn('measure')) this.bar.flip('measure');
    this.hint(words);
    this.picker.ask((point) => {
      this.picker.ask(null);
      this.hint(null);
      this.change(settings([point.x, point.y, point.z].map((x, k) => (x + (this.centre[k] ?? 0)) / this.settings.unit) as [number, number, number]));
    }, true);
    byId('view').focus();
  }

  // --- the way of a file

  private async open(files: File[]): Promise<void> {
    const labels = files.find((file) => file.name.toLowerCase().endsWith('.json'));
    const mesh = files.find((file) => file !== labels);
    if (!mesh) return;
    const asked = ++this.asked;
    await this.leave();
    this.progress.begin();
    this.progress.say('progress.sending');
    byId('welcome').hidden = true;
    this.sending = new AbortController();
    try {
      const sent = await api.sendScan(mesh, mesh.name, this.sending.signal);
      let scan = sent.scan;
      if (labels) scan = (await api.sendLabels(scan, labels, this.sending.signal)).scan;
      if (asked !== this.asked) return;
      this.scan = scan;
      await this.start(firstSettings(labels || sent.kind === 'arch' ? 'arch' : 'tooth'));
    } catch (error) {
      if (asked === this.asked) this.fail(error);
    }
  }

  /** A new job for the scan. The tooth that is there stays in view until there is another one. */
  private async start(settings: Settings): Promise<void> {
    if (!this.scan) return;
    const asked = ++this.asked;
    this.settings = settings;
    this.applied = settings;
    this.quiet();
    this.progress.begin();
    this.progress.say('progress.waiting');
    if (this.running) void api.cancel(this.running).catch(() => {});
    try {
      const id = await api.start(requestOf(this.scan, settings));
      if (asked !== this.asked) {
        void api.forget(id).catch(() => {});
        return;
      }
      this.running = id;
      this.keep(id);
      await this.finish(id, asked);
    } catch (error) {
      if (asked !== this.asked) return;
      this.fail(error);
      this.goBack();
      this.fill();
    }
  }

  private async finish(id: string, asked: number): Promise<void> {
    const job = await follow(id, this.progress);
    if (asked !== this.asked) return;
    this.running = null;
    if (job?.state === 'done') {
      const old = this.job;
      this.progress.stage('result');
      await this.showJob(job);
      if (old && old.job !== job.job) void api.forget(old.job).catch(() => {});
      this.shown = this.settings;
      this.hint(text('state.done', { seconds: job.seconds.toFixed(1) }));
    } else {
      this.say(job?.error ?? (job ? { kind: 'cancelled', sentence: text('state.cancelled') } : { kind: 'gone', sentence: text('state.gone') }));
      this.goBack();
    }
    this.progress.end();
    this.fill();
  }

  /** Where nothing new came of it, the settings are again those of what is in view. */
  private goBack(): void {
    if (!this.job || !this.shown) return;
    this.settings = this.shown;
    this.applied = this.shown;
    this.history.pop();
    this.keep(this.job.job);
  }

  private async showJob(job: Job): Promise<void> {
    const isOther = this.job?.kind !== job.kind;
    if (job.tooth) {
      const [tooth, crown] = await Promise.all([this.mesh(job.job, 'tooth'), this.mesh(job.job, 'crown')]);
      this.viewer.clear();
      this.viewer.setTooth(job.tooth.fdi, tooth, crown);
      this.viewer.setDirections({ up: vector(job.tooth.directions.occlusal), front: vector(job.tooth.directions.buccal) });
      if (!isSteered(job.tooth.options.steering as Steering)) {
        this.interval = job.tooth.interval;
        this.predicted = job.tooth.root_length_mm;
      }
    }
    if (job.arch) {
      this.viewer.clear();
      await this.showArch(job);
    }
    this.job = job;
    this.keep(job.job);
    byId('bar').hidden = false;
    byId('legend').hidden = false;
    byId('panel').hidden = false;
    byId('another').hidden = false;
    this.bar.fill(job.kind === 'arch');
    if (isOther) this.viewer.view('front');
    if (this.bar.isOn('ghosts')) void this.showGhosts();
  }

  private async showArch(job: Job): Promise<void> {
    const arch = job.arch;
    if (!arch) return;
    for (const tooth of arch.teeth) {
      const crown = await this.mesh(job.job, `crown-${tooth.fdi}`);
      const whole = tooth.rooted ? await this.mesh(job.job, `tooth-${tooth.fdi}`) : crown;  // without a root, what was scanned
      this.viewer.setTooth(tooth.fdi, whole, crown);
    }
    if (arch.has_gum) this.viewer.setGum(await this.mesh(job.job, 'gum'));
    this.viewer.showGum(this.bar.isOn('gum'));
    const first = arch.teeth.find((each) => each.tooth)?.tooth;
    if (arch.upright) this.viewer.setDirections({ up: vector(arch.upright[1] ?? [0, 0, 1]), front: vector(arch.upright[2] ?? [0, 1, 0]) });
    else if (first) this.viewer.setDirections({ up: vector(first.directions.occlusal), front: vector(first.directions.buccal) });
  }

  private async mesh(job: string, name: string): Promise<ReturnType<typeof readViewMesh>> {
    const mesh = readViewMesh(await api.view(job, name));
    this.centre = mesh.centre;
    return mesh;
  }

  // --- another root for the same crown

  private apply(settings: Settings): void {
    this.settings = settings;
    if (this.job && this.shown && !this.running && differInSteeringAlone(settings, this.shown)) {
      this.applied = settings;
      this.shown = settings;
      this.keep(this.job.job);
      this.steer(settings.steering);
      this.fill();
    } else {
      void this.start(settings);
    }
  }

  /** One request at a time; of what is asked for meanwhile only the latest. */
  private steer(steering: Steering): void {
    const isAtWork = this.isSteering && JSON.stringify(steering) === this.steeringNow;
    this.wanted = isAtWork ? null : steering;  // a slider that is let go asks for what its last move asked for
    if (!this.isSteering) void this.steerOn();
  }

  private async steerOn(): Promise<void> {
    this.isSteering = true;
    const asked = this.asked;
    while (this.wanted && this.job && asked === this.asked) {
      const steering = this.wanted;
      this.wanted = null;
      this.steeringNow = JSON.stringify(steering);
      this.working(true);
      try {
        const { tooth } = await api.steer(this.job.job, steering, new AbortController().signal);
        const mesh = await this.mesh(this.job.job, 'tooth');
        const crown = await this.mesh(this.job.job, 'crown');
        if (asked !== this.asked) break;
        this.quiet();
        this.take(tooth);
        this.viewer.setTooth(tooth.fdi, mesh, crown);
      } catch (error) {
        if (asked !== this.asked) break;
        this.fail(error);
        this.settings = { ...this.settings, steering: this.job?.tooth?.options.steering ?? {} };  // which is in view still
        this.applied = this.shown = this.settings;
      }
    }
    this.isSteering = false;
    this.working(false);
    if (!this.isMoving) this.fill();
  }

  private take(tooth: Tooth): void {
    if (!this.job) return;
    this.job = { ...this.job, tooth };
    if (!isSteered(tooth.options.steering as Steering)) {
      this.interval = tooth.interval;
      this.predicted = tooth.root_length_mm;
    }
    refillFacts(byId('panel'), this.state());
  }

  private working(on: boolean): void {
    const line = document.getElementById('working');
    if (line) line.textContent = on ? text('root.working') : '';
    byId('stage').setAttribute('aria-busy', String(on));
  }

  // --- the view

  private flipped(name: Switch, on: boolean): void {
    if (name === 'measure') this.measure.set(on);
    if (name === 'ghosts') {
      if (on) void this.showGhosts();
      else {
        this.viewer.setGhosts([]);
        this.hint(null);
      }
    }
  }

  private async showGhosts(): Promise<void> {
    if (!this.job?.tooth) return;
    try {
      const [shortest, longest] = await Promise.all([this.mesh(this.job.job, 'shortest'), this.mesh(this.job.job, 'longest')]);
      if (!this.bar.isOn('ghosts')) return;
      this.viewer.setGhosts([shortest, longest]);
      this.hint(text('ghosts.caption'));
    } catch (error) {
      this.hint(error instanceof Refused && error.status === 404 ? text('ghosts.none') : error instanceof Refused ? error.refusal.sentence : text('state.gone'));
    }
  }

  // --- words

  private hint(words: string | null): void {
    const hint = byId('hint');
    hint.hidden = words === null;
    hint.textContent = words ?? '';
  }

  private fail(error: unknown): void {
    this.progress.end();
    if (error instanceof DOMException && error.name === 'AbortError') this.say({ kind: 'cancelled', sentence: text('state.cancelled') });
    else this.say(error instanceof Refused ? error.refusal : { kind: 'gone', sentence: text('state.gone') });
    this.fill();
  }

  /** Says why something was not done, with what might help where the sentence names it. */
  private say(refusal: Refusal): void {
    const said = byId('said');
    const isOwn = refusal.kind === 'cancelled' || refusal.kind === 'gone';
    const count = refusal.ids_in_all ?? 0;
    const words = element('div', { class: 'words' });
    if (!isOwn) words.append(element('strong', {}, text('error.label')));
    words.append(element('span', { lang: isOwn ? language() : 'en' }, refusal.sentence + (count > 0 ? ` [${text('error.ids', { count })}]` : '')));
    said.replaceChildren(words);
    const help = (label: string, settings: Settings): void => {
      said.append(element('button', { type: 'button', click: () => this.change(settings) }, label));
    };
    if (this.scan && refusal.sentence.includes('--repair') && !this.settings.repair) help(text('error.repair'), { ...this.settings, repair: true });
    if (this.scan && refusal.sentence.includes('--skirt') && this.settings.skirt === 'keep') help(text('error.skirt'), { ...this.settings, skirt: 'drop' });
    said.append(element('button', { type: 'button', click: () => this.quiet() }, text('error.close')));
    said.hidden = false;
    if (!this.job) {
      byId('welcome').hidden = false;
      byId('panel').hidden = this.scan === null;
    }
  }

  private quiet(): void {
    byId('said').hidden = true;
  }

  private state(): PanelState {
    return { settings: this.settings, job: this.job, interval: this.interval, predicted: this.predicted };
  }

  private fill(): void {
    fillPanel(byId('panel'), this.state(), this);
  }

  private write(): void {
    document.documentElement.lang = language();
    fillTexts();
    byId('stage').dataset.release = text('drag.release');
    byId('language').replaceChildren(...languages().map(([code, name]) => element('option', { value: code, selected: code === language() }, name)));
    this.writeSamples();
    if (!this.bar.isOn('ghosts') && !this.bar.isOn('measure')) this.hint(null);
    else if (this.bar.isOn('ghosts') && this.job) this.hint(text('ghosts.caption'));
    if (this.job) this.bar.fill(this.job.kind === 'arch');
    this.fill();
  }

  private writeSamples(): void {
    byId('samples').replaceChildren(...this.samples.map((sample) => {
      const name = sample.kind === 'arch' ? text('drop.scan') : (sample.fdi ? text('tooth', { fdi: sample.fdi }) : sample.name) + (sample.skirt ? ` ${text('drop.skirt')}` : '');
      const open = async (): Promise<void> => {
        try {
          await this.open([new File([await api.sample(sample.name)], sample.name)]);
        } catch (error) {
          this.fail(error);
        }
      };
      return element('button', { type: 'button', 'data-sample': sample.name, click: () => void open() }, name);
    }));
  }

  // --- beginning, leaving, coming back

  private async leave(): Promise<void> {
    this.quiet();
    this.hint(null);
    this.sending?.abort();
    const old = this.running ?? this.job?.job;
    if (old) await api.forget(old).catch(() => {});
    if (this.scan) await api.forgetScan(this.scan).catch(() => {});
    this.job = null;
    this.scan = null;
    this.running = null;
    this.applied = null;
    this.shown = null;
    this.interval = null;
    this.predicted = null;
    this.wanted = null;
    this.history.clear();
    this.viewer.clear();
    sessionStorage.removeItem(kept);
    for (const id of ['bar', 'legend', 'panel', 'another']) byId(id).hidden = true;
  }

  private keep(job: string): void {
    if (!this.scan) return;
    const keeping: Kept = { scan: this.scan, job, settings: this.settings, interval: this.interval, predicted: this.predicted };
    sessionStorage.setItem(kept, JSON.stringify(keeping));
  }

  private async reopen(): Promise<void> {
    const stored = sessionStorage.getItem(kept);
    if (!stored) return;
    const before = JSON.parse(stored) as Kept;
    const asked = ++this.asked;
    this.scan = before.scan;
    this.settings = before.settings;
    this.applied = before.settings;
    this.interval = before.interval;
    this.predicted = before.predicted;
    try {
      await api.job(before.job);
    } catch {  // forgotten meanwhile
      sessionStorage.removeItem(kept);
      this.scan = null;
      this.settings = firstSettings('tooth');
      return;
    }
    byId('welcome').hidden = true;
    this.running = before.job;
    this.progress.begin();
    await this.finish(before.job, asked);
  }

  private cancel(): void {
    this.sending?.abort();
    if (this.running) void api.cancel(this.running).catch((error: unknown) => this.fail(error));
  }

  private listen(): void {
    const stage = byId('stage');
    const file = byId<HTMLInputElement>('file');
    byId('choose').addEventListener('click', () => file.click());
    byId('another').addEventListener('click', () => {
      ++this.asked;
      void this.leave().then(() => {
        byId('welcome').hidden = false;
        byId('choose').focus();
      });
    });
    file.addEventListener('change', () => {
      void this.open([...(file.files ?? [])]);
      file.value = '';
    });
    document.addEventListener('dragover', (event) => {
      event.preventDefault();
      stage.classList.add('dropping');
    });
    document.addEventListener('dragleave', (event) => {
      if (event.relatedTarget === null) stage.classList.remove('dropping');
    });
    document.addEventListener('drop', (event) => {
      event.preventDefault();
      stage.classList.remove('dropping');
      void this.open([...(event.dataTransfer?.files ?? [])]);
    });
    document.addEventListener('keydown', (event) => {
      if (event.key === 'Escape' && !byId('progress').hidden) this.cancel();
      if (event.key.toLowerCase() === 'z' && (event.ctrlKey || event.metaKey) && !(event.target instanceof HTMLInputElement && event.target.type === 'number')) {
        event.preventDefault();
        this.undo();
      }
    });
    byId('cancel').addEventListener('click', () => this.cancel());
    byId('language').addEventListener('change', (event) => {
      setLanguage((event.currentTarget as HTMLSelectElement).value as Language);
      this.write();
    });
    followTheme(byId('theme'));
  }
}

void new Page().begin();
