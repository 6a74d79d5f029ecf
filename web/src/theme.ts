// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import { recall, remember } from './memory';

const kept = 'rhizodont.theme';

function theme(): string {
  return recall(kept) ?? (matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light');
}

function show(): void {
  document.documentElement.dataset['theme'] = theme();
}

/** Light or dark as the system has it, until the button says otherwise. */
export function followTheme(button: HTMLElement): void {
  show();
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', show);
  button.addEventListener('click', () => {
    remember(kept, theme() === 'dark' ? 'light' : 'dark');
    show();
  });
}
