#!/usr/bin/env python3
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sends hostile requests to `rhizodont serve`: hostile_requests.py [N=1000] [--program PROGRAM] [--seed S].

Starts the program on a free port, sends N requests drawn from the kinds below, some of them 50 at once, and asks in between
whether a crown is still completed. Kinds: oversized, truncated and malformed requests, path tricks, wrong types, slow clients,
disconnects in the middle, foreign hosts and origins, packed files that unpack to far more, broken meshes.
Ends with 1 if the program ends, does not answer, answers otherwise than with 4xx or 5xx and JSON, or needs more than 1.5 GB."""

import argparse
import collections
import concurrent.futures
import gzip
import json
import pathlib
import random
import socket
import subprocess
import sys
import time

SOURCE = pathlib.Path(__file__).resolve().parent.parent
MOST_MEMORY = 1_500_000_000


class Service:
    def __init__(self, program):
        self.process = subprocess.Popen([program, 'serve', '--port', '0', '--quiet'], stdout=subprocess.PIPE, text=True)
        self.port = int(self.process.stdout.readline().split('127.0.0.1:')[1].split('/')[0])

    def memory(self, key='VmHWM'):
        for line in pathlib.Path(f'/proc/{self.process.pid}/status').read_text().splitlines():
            if line.startswith(key + ':'):
                return int(line.split()[1]) * 1024
        return 0

    def connect(self, timeout=40):
        return socket.create_connection(('127.0.0.1', self.port), timeout=timeout)

    def answer(self, sock):
        """(status, body) of the answer; None if the connection was closed without one."""
        data = b''
        try:
            while chunk := sock.recv(65536):
                data += chunk
        except ConnectionError:
            pass
        if not data.startswith(b'HTTP/1.1 '):
            return None
        while data.startswith(b'HTTP/1.1 100'):
            data = data.split(b'\r\n\r\n', 1)[1]
        head, _, body = data.partition(b'\r\n\r\n')
        return int(head.split()[1]), body

    def ask(self, raw, finish=False):
        with self.connect() as sock:
            try:
                sock.sendall(raw)
                if finish:
                    sock.shutdown(socket.SHUT_WR)
            except ConnectionError:
                pass  # refused before all was sent: the answer is there
            return self.answer(sock)

    def request(self, method, path, body=b'', headers=None, length=None):
        fields = {'Host': f'127.0.0.1:{self.port}', 'Content-Length': str(len(body) if length is None else length), **(headers or {})}
        head = f'{method} {path} HTTP/1.1\r\n' + ''.join(f'{k}: {v}\r\n' for k, v in fields.items() if v is not None) + '\r\n'
        return head.encode('latin-1', 'replace') + body


OCTETS = {'Content-Type': 'application/octet-stream'}
JSON = {'Content-Type': 'application/json'}


def binary_stl(rng, triangles):
    return b'\0' * 80 + triangles.to_bytes(4, 'little') + rng.randbytes(50 * min(triangles, 40))


def kinds(service, rng, crown):
    """Name -> function that sends one request of that kind and gives its answer."""
    request, ask = service.request, service.ask
    some_id = '%032x' % rng.getrandbits(128)

    def scan(body, **more):
        return ask(request('POST', '/api/v1/scans?name=crown_36.stl', body, {**OCTETS, **more}))

    def job(body, **more):
        return ask(request('POST', '/api/v1/jobs', body, {**JSON, **more}))

    def disconnect():
        with service.connect() as sock:
            raw = request('POST', '/api/v1/scans', crown, OCTETS)
            sock.sendall(raw[:rng.randrange(1, len(raw))])
        return 'gone'

    def slow():
        with service.connect() as sock:
            try:
                for byte in b'POST /api/v1/scans HTTP/1.1\r\nHost: 127.0.0.1\r\nX-Slow: ' + b'a' * 200:
                    sock.sendall(bytes([byte]))
                    time.sleep(0.3)
            except ConnectionError:
                pass
            return service.answer(sock)

    def slow_body():
        with service.connect() as sock:
            sock.sendall(request('POST', '/api/v1/scans', b'solid', OCTETS, length=100000))
            return service.answer(sock)

    def endless_head():
        return ask(b'GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n' + b'X-More: 1\r\n' * 20000)

    def chunked(size):
        piece = b'%x\r\n' % 65536 + b'a' * 65536 + b'\r\n'
        return ask(request('POST', '/api/v1/scans', b'', {**OCTETS, 'Content-Length': None, 'Transfer-Encoding': 'chunked'}) +
                   piece * (size // 65536) + b'0\r\n\r\n')

    def mutated():
        raw = bytearray(request('POST', '/api/v1/jobs', b'{"scan": "%s"}' % some_id.encode(), JSON))
        for _ in range(rng.randrange(1, 12)):
            raw[rng.randrange(len(raw))] = rng.randrange(256)
        return ask(bytes(raw), finish=True)

    def mutated_crown():
        raw = bytearray(crown)
        for _ in range(rng.randrange(1, 40)):
            raw[rng.randrange(len(raw))] = rng.randrange(256)
        raw = raw[:rng.randrange(1, len(raw))]
        return scan(bytes(raw))

    tricks = ['/../../etc/passwd', '/%2e%2e/%2e%2e/etc/passwd', '/api/v1/jobs/../../x', '/api/v1/samples/..%2findex.html',
              '/api/v1/samples/' + 'a' * 9000, '/api/v1/jobs/' + some_id + '/files/..%2f..%2fetc%2fpasswd', '/%00', '/\xff\xfe',
              '/api/v1/jobs/' + 'f' * 33, '//api//v1', '/api/v1/jobs/' + some_id + '/files/tooth.ply%00.txt', '/api/v1/samples/' + 'a.' * 90]
    bodies = [b'', b'{', b'[]', b'null', b'{"scan": 1}', b'{"scan": "%s"}' % some_id.encode(), b'[' * 15000, b'{"a":' * 3000, b'\xff\xfe\x00',
              b'{"scan": "x", "options": {"e_mm": 1e999}}', b'{"scan": "x", "options": {"fdi": -1, "threads": 999999999}}', b'"' + b'a' * 15000 + b'"',
              b'{"scan": "x", "kind": "arch", "root_lengths_mm": {"36": "long"}}']
    return {
        'random bytes': lambda: ask(rng.randbytes(rng.randrange(1, 4000)) + b'\r\n\r\n', finish=True),
        'path tricks': lambda: ask(request('GET', rng.choice(tricks))),
        'wrong method': lambda: ask(request(rng.choice(['PUT', 'PATCH', 'OPTIONS', 'TRACE', 'FOO', 'DELETE', 'POST']), '/api/v1/about')),
        'broken job': lambda: job(rng.choice(bodies)),
        'job of a wrong type': lambda: ask(request('POST', '/api/v1/jobs', b'{}', {'Content-Type': rng.choice(['text/plain', 'multipart/form-data; boundary=x', 'application/x-www-form-urlencoded'])})),
        'multipart scan': lambda: ask(request('POST', '/api/v1/scans', b'--x\r\nContent-Disposition: form-data; name="a"\r\n\r\n' + crown + b'\r\n--x--', {'Content-Type': 'multipart/form-data; boundary=x'})),
        'random mesh': lambda: scan(rng.randbytes(rng.randrange(0, 20000))),
        'STL that lies': lambda: scan(binary_stl(rng, rng.choice([0, 5, 2**31, 2**32 - 1]))),
        'mutated crown': mutated_crown,
        'PLY that lies': lambda: scan(b'ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n'),
        'not a number': lambda: scan(b'solid x\nfacet normal 0 0 0\nouter loop\nvertex nan 0 0\nvertex 1 inf 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n'),
        'bomb': lambda: scan(gzip.compress(b'\0' * (80 << 20), 1)),
        'packed body': lambda: scan(gzip.compress(b'a' * (80 << 20), 1), **{'Content-Encoding': 'gzip'}),
        'length too large': lambda: ask(request('POST', '/api/v1/scans', b'x' * 1000, OCTETS, length=rng.choice([10**10, 10**18, 70 << 20])), finish=True),
        'length that is none': lambda: ask(request('POST', '/api/v1/scans', b'x', OCTETS, length=rng.choice(['-1', 'abc', '1e3', '']))),
        'truncated': lambda: ask(request('POST', '/api/v1/scans', crown[:2000], OCTETS, length=len(crown)), finish=True),
        'too large in pieces': lambda: chunked(70 << 20),
        'broken pieces': lambda: ask(request('POST', '/api/v1/scans', b'zz\r\nabc\r\n', {**OCTETS, 'Content-Length': None, 'Transfer-Encoding': 'chunked'}), finish=True),
        'no length': lambda: ask(request('POST', '/api/v1/scans', b'', {**OCTETS, 'Content-Length': None})),
        'endless head': endless_head,
        'long line': lambda: ask(b'GET /' + b'a' * 60000 + b' HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n'),
        'foreign host': lambda: ask(request('GET', '/api/v1/about', headers={'Host': rng.choice(['evil.example', '10.0.0.1', '127.0.0.1.nip.io', ''])})),
        'foreign origin': lambda: ask(request('POST', '/api/v1/jobs', b'{}', {**JSON, 'Origin': 'http://evil.example'})),
        'range': lambda: ask(request('GET', '/api/v1/samples/crown_36.stl', headers={'Range': 'bytes=' + '0-,' * 500 + '0-'})),
        'unknown job': lambda: ask(request('GET', f'/api/v1/jobs/{some_id}' + rng.choice(['/events', '/views/tooth', '/files/all.zip', '']))),
        'mutated request': mutated,
        'disconnect': disconnect,
        'slow head': slow,
        'slow body': slow_body,
    }


SLOW = {'slow head', 'slow body'}
HEAVY = {'bomb', 'packed body', 'too large in pieces'}


def complete(service, crown):
    """Sends a crown and waits for its tooth: what is to work whatever else is sent."""
    status, body = service.ask(service.request('POST', '/api/v1/scans?name=crown_36.stl', crown, OCTETS))
    assert status == 201, (status, body)
    status, body = service.ask(service.request('POST', '/api/v1/jobs', json.dumps({'scan': json.loads(body)['scan'], 'options': {'e_mm': 1}}).encode(), JSON))
    assert status == 202, (status, body)
    job = json.loads(body)['job']
    while True:
        status, body = service.ask(service.request('GET', f'/api/v1/jobs/{job}'))
        state = json.loads(body)['state']
        if state not in ('waiting', 'running'):
            assert state == 'done', body
            return
        time.sleep(0.05)


def fault_of(name, answer):
    """What is wrong with an answer; None if nothing is."""
    if answer == 'gone':
        return None
    if answer is None:
        return 'no answer'
    status, body = answer
    if name == 'mutated request' and status < 400:
        return None  # the change may have left a request that is in order
    if name in ('mutated crown', 'STL that lies') and status == 201:
        return None  # what is left of a crown may still be a mesh, and so may triangles at random
    if not 400 <= status < 600:
        return f'answered {status}'
    try:
        return None if json.loads(body)['error']['sentence'] else 'no sentence'
    except (ValueError, KeyError, TypeError):
        return f'{status} without JSON: {body[:80]!r}'


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('count', nargs='?', type=int, default=1000)
    parser.add_argument('--program', default=str(SOURCE / 'build/apps/rhizodont/rhizodont'))
    parser.add_argument('--seed', type=int, default=1)
    arguments = parser.parse_args()
    rng = random.Random(arguments.seed)
    crown = (SOURCE / 'samples/crown_36.stl').read_bytes()
    service = Service(arguments.program)
    counts, faults = collections.Counter(), []
    begun = time.time()
    try:
        complete(service, crown)
        print(f'before: {service.memory() / 1e6:.0f} MB at most')
        names = list(kinds(service, rng, crown))
        drawn = list(names)
        while len(drawn) < arguments.count:
            name = rng.choice(names)
            if (name in SLOW and rng.random() > 0.25) or (name in HEAVY and rng.random() > 0.25):
                continue
            drawn.append(name)

        def send(name):
            own = random.Random(rng.getrandbits(64))
            try:
                return name, kinds(service, own, crown)[name]()
            except (OSError, ValueError, IndexError) as error:
                return name, None if not isinstance(error, TimeoutError) else (0, b'timeout')

        for start in range(0, len(drawn), 100):
            batch = drawn[start:start + 100]
            with concurrent.futures.ThreadPoolExecutor(50 if start % 200 == 0 else 8) as pool:
                for name, answer in pool.map(send, batch):
                    counts[name] += 1
                    if fault := fault_of(name, answer):
                        faults.append(f'{name}: {fault}')
            if service.process.poll() is not None:
                faults.append(f'the program ended with {service.process.returncode}')
                break
            complete(service, crown)
        if service.process.poll() is None and service.memory() > MOST_MEMORY:
            faults.append(f'memory: {service.memory() / 1e6:.0f} MB')
        memory = service.memory() / 1e6, service.memory('VmRSS') / 1e6
    finally:
        if service.process.poll() is None:
            service.process.terminate()
            service.process.wait(30)
    for name in sorted(counts):
        print(f'{counts[name]:5} {name}')
    for fault, count in collections.Counter(faults).items():
        print(f'FAULT {fault} ({count} times)')
    print(f'{sum(counts.values())} requests in {time.time() - begun:.0f} s, memory at most {memory[0]:.0f} MB, at the end {memory[1]:.0f} MB, '
          f'{len(faults)} faults')
    return 1 if faults else 0


if __name__ == '__main__':
    sys.exit(main())
