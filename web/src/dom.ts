// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import { text, type TextKey } from './texts';

type Attributes = Record<string, string | number | boolean | ((event: Event) => void)>;

/** An element with attributes (functions become listeners, false leaves out) and children. */
export function element<K extends keyof HTMLElementTagNameMap>(
  tag: K, attributes: Attributes = {}, ...children: (Node | string)[]): HTMLElementTagNameMap[K] {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === 'function') made.addEventListener(name, value);
    else if (value !== false) made.setAttribute(name, value === true ? '' : String(value));
  }
  made.append(...children);
  return made;
}

/** The element of the page with this id. */
export function byId<T extends HTMLElement = HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (!found) throw new Error('the page has no ' + id);
  return found as T;
}

/** Puts texts where the page asks for them: data-text, and data-label for aria-label and title. */
export function fillTexts(root: ParentNode = document): void {
  for (const e of root.querySelectorAll<HTMLElement>('[data-text]')) e.textContent = text(e.dataset.text as TextKey);
  for (const e of root.querySelectorAll<HTMLElement>('[data-label]')) {
    const label = text(e.dataset.label as TextKey);
    e.setAttribute('aria-label', label);
    e.title = e.dataset.key ? `${label} (${e.dataset.key})` : label;
  }
}
