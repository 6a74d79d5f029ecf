// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import { recall, remember } from './memory';
import de from './texts/de.json';
import en from './texts/en.json';

export type TextKey = keyof typeof en;
export type Language = 'en' | 'de';

// Both languages have the very same texts, or this does not compile.
const texts: Record<Language, Record<TextKey, string>> = { en, de };
const unknown: Record<Exclude<keyof typeof de, TextKey>, never> = {};
void unknown;

const kept = 'rhizodont.language';

function first(): Language {
  const chosen = recall(kept) ?? navigator.language;
  return chosen.startsWith('de') ? 'de' : 'en';
}

let current: Language = first();

export function language(): Language {
  return current;
}

export function setLanguage(chosen: Language): void {
  current = chosen;
  remember(kept, chosen);
}

export function languages(): [Language, string][] {
  return [['en', en.language], ['de', de.language]];
}

/** The text in the language chosen, with {names} replaced. */
export function text(key: TextKey, values: Record<string, string | number> = {}): string {
  return texts[current][key].replace(/\{(\w+)\}/g, (whole, name: string) => String(values[name] ?? whole));
}

export function isTextKey(key: string): key is TextKey {
  return key in en;
}

export function number(value: number, digits: number): string {
  return value.toLocaleString(current, { minimumFractionDigits: digits, maximumFractionDigits: digits });
}
