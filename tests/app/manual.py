#!/usr/bin/env python3
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The manual and the completions of a program, against what its --help says: manual.py PROGRAM. Pages must be without a
warning of groff, each must name every option of its command, and shells must offer them. zsh and fish are tried where
they are installed."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve()
NAME = PROGRAM.name


def run(*words, **more):
    return subprocess.run(words, check=True, capture_output=True, text=True, **more).stdout


def help_of(path):
    return run(PROGRAM, *path, '--help')


def options_in(text):
    """The options as the help lists them, at the beginning of their lines."""
    found = set()
    for line in text.splitlines():
        if match := re.match(r'  (-[-\w]+(?:,-[-\w]+)*)', line):
            found.update(match.group(1).split(','))
    return found


def commands_in(text):
    part = text.split('Subcommands:')[1] if 'Subcommands:' in text else ''
    return re.findall(r'^  (\w[-\w]*) ', part, re.M)


def all_paths(path=()):
    yield path
    for command in commands_in(help_of(path)):
        yield from all_paths((*path, command))


PATHS = list(all_paths())


class Commands(unittest.TestCase):
    def test_all_can_be_quiet_and_verbose(self):
        for path in PATHS[1:]:
            self.assertLessEqual({'--quiet', '--verbose'}, options_in(help_of(path)), path)


class Manual(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.pages = pathlib.Path(cls.folder.name)
        run(PROGRAM, 'manual', '-o', cls.pages)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def page(self, path):
        return self.pages / ('-'.join([NAME, *path]) + '.1')

    def read(self, path):
        # one line for each paragraph, as plain letters
        text = run('man', '-l', '-Tutf8', '-P', 'cat', str(self.page(path)),
                   env={**os.environ, 'MANWIDTH': '2000', 'LC_ALL': 'C.UTF-8', 'GROFF_NO_SGR': '1'})
        return re.sub('.\b', '', text)

    def test_every_command_has_a_page(self):
        self.assertGreater(len(PATHS), 5)
        self.assertEqual(sorted(p.name for p in self.pages.iterdir()), sorted(self.page(path).name for path in PATHS))

    def test_groff_warns_of_nothing(self):
        for path in PATHS:
            done = subprocess.run(['man', '--warnings', '-E', 'UTF-8', '-l', '-Tutf8', '-Z', str(self.page(path))],
                                  capture_output=True, text=True, env={**os.environ, 'LC_ALL': 'C.UTF-8', 'MANROFFSEQ': ''})
            self.assertEqual((done.returncode, done.stderr), (0, ''), path)

    def test_pages_name_every_option_and_command(self):
        for path in PATHS:
            text, said = self.read(path), help_of(path)
            self.assertTrue(options_in(said))
            for word in [*options_in(said), *commands_in(said)]:
                self.assertRegex(text, r'(?m)^ +(?:\S+, )?' + re.escape(word) + r'(?![-\w])', (path, word))

    def test_pages_say_what_an_option_is_for_and_takes(self):
        text = self.read(('complete',)) if ('complete',) in PATHS else None
        if text is None:
            self.skipTest('not the program that completes')
        self.assertRegex(text, r'--format ply\|stl|--format stl\|ply')
        self.assertRegex(text, r'--threads NUMBER\s+At most so many threads; 0 = all. Default: 0\.')
        self.assertRegex(text, r'--cap drop\|keep')
        self.assertRegex(text, r'--skirt keep\|auto\|TEXT')
        self.assertRegex(text, r'(?s)EXIT STATUS.*3\s+unusable input\.')
        self.assertIn('RHIZODONT_MODELS', text)
        self.assertRegex(text, r'rhizodont complete CROWN \.\.\. -o TEXT \[OPTIONS\]')

    def test_a_page_alone(self):
        self.assertEqual(run(PROGRAM, 'manual', *PATHS[1]), self.page(PATHS[1]).read_text())
        refused = subprocess.run([PROGRAM, 'manual', '-o', self.pages], capture_output=True, text=True)
        self.assertEqual(refused.returncode, 2)  # pages are there already
        self.assertEqual(subprocess.run([PROGRAM, 'manual', 'nothing'], capture_output=True).returncode, 2)
        with tempfile.TemporaryDirectory() as name:
            refused = subprocess.run([PROGRAM, 'manual', '-o', '-'], capture_output=True, text=True, cwd=name)
            self.assertEqual((refused.returncode, list(pathlib.Path(name).iterdir())), (2, []))


class Completion(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)

    def script(self, shell):
        file = self.folder / shell
        file.write_text(run(PROGRAM, 'shell-completion', shell))
        return file

    def bash(self, *words):
        line = ' '.join(f"'{word}'" for word in [NAME, *words])
        command = (f"source '{self.script('bash')}'; COMP_WORDS=({line}); COMP_CWORD={len(words)}; "
                   f"_{NAME.replace('-', '_')}; printf '%s\\n' \"${{COMPREPLY[@]}}\"")
        return run('bash', '-uc', command, cwd=self.folder).split()

    def test_bash_offers_all_commands_and_options(self):
        for path in PATHS:
            said = help_of(path)
            self.assertEqual(set(self.bash(*path, '-')), options_in(said), path)
            if commands := commands_in(said):
                self.assertLessEqual(set(commands), set(self.bash(*path, '')), path)

    def test_bash_offers_what_an_option_takes(self):
        if ('complete',) not in PATHS:
            self.skipTest('not the program that completes')
        numberings = ['fdi', 'universal', 'arch14', 'arch16']
        for words, choices in [(('complete', '--skirt'), ['keep', 'auto']), (('batch', '--skirt'), ['keep', 'auto']),
                               (('complete', '--unit'), ['mm', 'cm', 'm', 'um', 'in']), (('arch', '--labels-are'), numberings),
                               (('register', '--labels-are'), numberings), (('segment', '--numbers'), numberings),
                               (('render', '--color-by'), ['auto', 'source', 'fdi', 'none']),
                               (('arch', '--first-label'), ['right', 'left']), (('segment', '--jaw'), ['upper', 'lower'])]:
            self.assertEqual(self.bash(*words, ''), choices, words)
        self.assertEqual(self.bash('shell-completion', '')[:3], ['bash', 'zsh', 'fish'])
        self.assertEqual(self.bash('shell-completion', 'f'), ['fish'])
        self.assertIn('oblique', self.bash('render', '--views', ''))
        self.assertCountEqual(self.bash('complete', '--ca'), ['--cap', '--candidates'])
        self.assertEqual(self.bash('complete', '--cap', ''), ['drop', 'keep'])
        self.assertEqual(self.bash('complete', '--output-format', 's'), ['stl'])
        self.assertEqual(self.bash('complete', '--output-format', '=', 's'), ['stl'])
        self.assertEqual(self.bash('complete', '--output-format', '='), ['ply', 'stl', 'obj', 'glb'])
        self.assertEqual(self.bash('complete', 'crown.ply', '-o', '-'), [])  # names of files are bash's own
        self.assertEqual(self.bash('complete', 'cr'), [])
        self.assertEqual(self.bash('batch', 'st'), ['status'])
        self.assertIn('--cases', self.bash('batch', 'status', '--'))
        self.assertNotIn('--cases', self.bash('batch', '--'))
        self.assertEqual(self.bash('chec'), ['check'])

    @unittest.skipUnless(shutil.which('fish'), 'fish is not installed')
    def test_fish(self):
        script = self.script('fish')

        def fish(line):
            text = run('fish', '-c', f"source '{script}'; complete -C '{line}'", cwd=self.folder, env={**os.environ, 'HOME': str(self.folder)})
            return {entry.split('\t')[0] for entry in text.splitlines()}

        for path in PATHS:
            said = help_of(path)
            offered = fish(' '.join([NAME, *path, '--']))
            self.assertEqual({o for o in offered if o.startswith('--')}, {o for o in options_in(said) if o.startswith('--')}, path)
            self.assertLessEqual(set(commands_in(said)), fish(' '.join([NAME, *path, ''])), path)
        if ('complete',) in PATHS:
            self.assertEqual(fish(f'{NAME} complete --cap '), {'drop', 'keep'})
            self.assertEqual(fish(f'{NAME} shell-completion '), {'bash', 'zsh', 'fish'})

    @unittest.skipUnless(shutil.which('zsh'), 'zsh is not installed')
    def test_zsh(self):
        script = self.script('zsh')
        subprocess.run(['zsh', '-n', script], check=True)
        functions = self.folder / 'functions'
        functions.mkdir()
        shutil.copy(script, functions / f'_{NAME}')
        typing = self.folder / 'typing.zsh'
        # a shell in a terminal of its own, in which Tab is pressed
        typing.write_text(r'''
zmodload zsh/zpty
zpty shell "cd '$1'; TERM=dumb zsh -f -i"
send() { zpty -w shell "$1"; }
send "PS1=; fpath=('$1/functions' \$fpath); autoload -Uz compinit; compinit -u -d '$1/dump'; zstyle ':completion:*' list-prompt ''; LISTMAX=10000; setopt no_always_last_prompt; print ready"
local text= piece=
while zpty -r shell piece; do text+=$piece; [[ $text == *$'\n'ready* ]] && break; done
zpty -w -n shell "$2"$'\t\t'
sleep 1
text=
while zpty -r -t shell piece; do text+=$piece; done
print -r -- "$text"
zpty -d shell
''')

        def zsh(line):
            return run('zsh', '-f', str(typing), str(self.folder), line, timeout=60, env={**os.environ, 'PATH': f'{PROGRAM.parent}:{os.environ["PATH"]}'})

        first = PATHS[1]
        text = zsh(f'{NAME} ')
        for command in commands_in(help_of(())):
            self.assertIn(command, text)
        text = zsh(f'{NAME} {" ".join(first)} --')
        for option in options_in(help_of(first)):
            if option.startswith('--'):
                self.assertIn(option, text)
        if ('complete',) in PATHS:
            self.assertIn('--cap keep', zsh(f'{NAME} complete --cap k'))
            self.assertIn('shell-completion fish', zsh(f'{NAME} shell-completion f'))


if __name__ == '__main__':
    unittest.main()
