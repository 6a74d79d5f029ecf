// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import config from '../playwright.config';

// Times to be printed, not tests: scripts/page_times.sh.
export default { ...config, testDir: '.', timeout: 600_000 };
