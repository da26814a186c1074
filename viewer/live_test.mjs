// The live page in headless Chromium: live_test.mjs AVBD CHROMIUM WORK_FOLDER.
import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import {mkdirSync, mkdtempSync, rmSync} from 'node:fs';
import http from 'node:http';
import net from 'node:net';
import {join, resolve} from 'node:path';
import {chromium} from 'playwright-core';

const [avbd, browserPath, folder] = process.argv.slice(2);
mkdirSync(resolve(folder), {recursive: true});
const work = mkdtempSync(join(resolve(folder), 'live-'));
const running = new Set();

/// Starts avbd; `place` resolves with the page's address, `ended` with the exit status.
function start(...args) {
  const child = spawn(avbd, args, {cwd: work});
  running.add(child);
  let text = '';
  const ended = new Promise((done) => child.on('close', (status) => {
    running.delete(child);
    done({status, text});
  }));
  const place = new Promise((done, fail) => {
    const look = (part) => {
      text += part;
      const found = text.match(/http:\/\/127\.0\.0\.1:(\d+)\//);
      if (found) done({url: found[0], port: Number(found[1])});
    };
    child.stdout.on('data', look);
    child.stderr.on('data', look);
    ended.then(() => fail(new Error(`avbd ${args.join(' ')} ended: ${text}`)));
  });
  place.catch(() => {});
  return {child, place, ended};
}

const browser = await chromium.launchPersistentContext(join(work, 'profile'), {
  executablePath: browserPath, headless: true, viewport: {width: 900, height: 600}, colorScheme: 'dark',
  args: ['--headless', '--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking',
         '--disable-component-update', '--disable-sync', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
});

async function open(url) {
  const page = await browser.newPage();
  const complaints = [];
  page.on('console', (message) => {
    if (message.type() === 'error' || message.type() === 'warning') complaints.push(message.text());
  });
  page.on('pageerror', (error) => complaints.push(String(error)));
  await page.goto(url);
  await page.waitForFunction(() => window.avbdViewer, null, {timeout: 60000});
  await page.evaluate(() => window.avbdViewer.setQuality('3'));
  return {page, complaints};
}
const ask = (page, question, value) => page.evaluate(question, value);

/// Status of a raw request.
function request(port, options) {
  return new Promise((done, fail) => {
    const asked = http.request({host: '127.0.0.1', port, agent: false, ...options}, (answer) => {
      answer.resume();
      answer.on('end', () => done(answer.statusCode));
    });
    asked.on('upgrade', (answer, socket) => {
      socket.destroy();
      done(answer.statusCode);
    });
    asked.on('error', fail);
    asked.end();
  });
}

/// What a server says to these bytes.
function raw(port, bytes) {
  return new Promise((done) => {
    const socket = net.connect(port, '127.0.0.1', () => socket.write(bytes));
    let text = '';
    socket.on('data', (part) => { text += part; });
    socket.on('close', () => done(text));
    socket.on('error', () => done(text));
    setTimeout(() => socket.destroy(), 3000);
  });
}

async function testFinished(file) {
  const server = start('play', file, '--port', '0');
  const {url, port} = await server.place;
  const {page, complaints} = await open(url);
  assert.equal(await ask(page, () => window.avbdViewer.finished), true);
  const frames = await ask(page, () => window.avbdViewer.recording.frames);
  assert.ok(frames >= 60, `${frames} frames`);
  const height = async (time) => {
    await ask(page, (at) => window.avbdViewer.seek(at), time);
    await page.waitForFunction((at) => Math.abs(window.avbdViewer.time - at) < 1e-6, time);
    await page.waitForTimeout(500);
    return ask(page, () => window.avbdViewer.poseOf(1));
  };
  await page.keyboard.press('e');  // leaves the end
  const before = await height(0.1), after = await height(0.9);
  assert.ok(before.some((value, i) => Math.abs(value - after[i]) > 1e-3), 'a body moves between two times');
  await ask(page, () => { window.avbdViewer.seek(0); window.avbdViewer.play(); });
  await page.waitForFunction(() => window.avbdViewer.time > 0.3);
  await ask(page, () => window.avbdViewer.pause());
  await ask(page, () => window.avbdViewer.toggle('reactions', true));
  await page.waitForFunction(() => window.avbdViewer.jointLines().forces > 0, null, {timeout: 10000});
  const second = await open(url);
  assert.equal(await ask(second.page, () => window.avbdViewer.recording.frames), frames);
  await page.screenshot({path: join(resolve(folder), 'live.png')});
  await ask(page, () => window.avbdViewer.select(window.avbdViewer.recording.bodies - 1));
  await page.waitForFunction(() => window.avbdViewer.pathLines > 50, null, {timeout: 10000});

  assert.equal(await request(port, {path: '/'}), 200);
  assert.equal(await request(port, {path: '/', method: 'HEAD'}), 200);
  assert.equal(await request(port, {path: '/../etc/passwd'}), 404);
  assert.equal(await request(port, {path: '/', method: 'POST'}), 405);
  assert.equal(await request(port, {path: '/', headers: {Host: 'evil.example'}}), 403);
  const upgrade = {Connection: 'Upgrade', Upgrade: 'websocket', 'Sec-WebSocket-Version': '13', 'Sec-WebSocket-Key': 'dGhlIHNhbXBsZSBub25jZQ=='};
  assert.equal(await request(port, {path: '/stream', headers: {...upgrade, Origin: 'http://evil.example'}}), 403);
  assert.equal(await request(port, {path: '/stream', headers: {...upgrade, Origin: `http://localhost:${port}`}}), 101);
  assert.match(await raw(port, 'GARBAGE\r\n\r\n'), /^HTTP\/1\.1 400 /);
  assert.match(await raw(port, `GET / HTTP/1.1\r\nX: ${'x'.repeat(20000)}\r\n\r\n`), /^(HTTP\/1\.1 400 |$)/);

  const taken = await start('play', file, '--port', String(port)).ended;
  assert.equal(taken.status, 2);
  assert.match(taken.text, new RegExp(`port ${port}: Address already in use`));

  server.child.kill('SIGINT');
  assert.equal((await server.ended).status, 0);
  assert.deepEqual([...complaints, ...second.complaints].filter((text) => !/ERR_CONNECTION_REFUSED|WebSocket/.test(text)), []);
  await page.close();
  await second.page.close();
}

/// Of a long recording a click asks for some frames along the body's path, not for all.
async function testPath(file) {
  const server = start('play', file, '--port', '0');
  const {page, complaints} = await open((await server.place).url);
  await page.keyboard.press('e');
  const frames = await ask(page, () => window.avbdViewer.recording.frames);
  await page.waitForTimeout(1000);
  const before = await ask(page, () => window.avbdViewer.framesHeld);
  await ask(page, () => window.avbdViewer.select(window.avbdViewer.recording.bodies - 1));
  await page.waitForFunction(() => window.avbdViewer.pathLines > 100, null, {timeout: 20000});
  await page.waitForTimeout(1000);
  const asked = await ask(page, () => window.avbdViewer.framesHeld) - before;
  assert.ok(frames > 900 && asked > 100 && asked < 400, `${asked} of ${frames} frames`);
  server.child.kill('SIGINT');
  await server.ended;
  assert.deepEqual(complaints.filter((text) => !/ERR_CONNECTION_REFUSED|WebSocket/.test(text)), []);
  await page.close();
}

/// Soft bodies come frame by frame, as places of their points.
async function testSoft(file) {
  const server = start('play', file, '--port', '0');
  const {page, complaints} = await open((await server.place).url);
  await page.keyboard.press('e');
  const at = async (time) => {
    await ask(page, (value) => window.avbdViewer.seek(value), time);
    await page.waitForFunction((value) => window.avbdViewer.has(window.avbdViewer.frame) && window.avbdViewer.time === value, time);
    await page.waitForTimeout(500);
    return ask(page, () => ({softs: window.avbdViewer.softs(), pose: window.avbdViewer.poseOf(window.avbdViewer.softs()[4].first)}));
  };
  const before = await at(0), after = await at(0.4);
  assert.deepEqual(before.softs.map(({name, points}) => [name, points]),
                   [0, 1, 2, 3, 4].map((i) => [`cube${i}`, 180]));
  for (const {volume, restVolume, largest} of before.softs) {
    assert.ok(Math.abs(volume / restVolume - 1) < 1e-5 && Math.abs(largest) < 1e-4, 'at first nothing is strained');
  }
  const fallen = before.pose[1] - after.pose[1];
  assert.ok(Math.abs(fallen - 4.905 * 0.4 * 0.4) < 0.08, `the highest cube falls: ${fallen}`);
  assert.ok(Math.abs(after.softs[0].largest) > 0.01, 'the lowest is on the ground');
  server.child.kill('SIGINT');
  await server.ended;
  assert.deepEqual(complaints.filter((text) => !/ERR_CONNECTION_REFUSED|WebSocket/.test(text)), []);
  await page.close();
}

/// The page follows a run that still goes on, and sees its end.
async function testGrowing() {
  const server = start('run', 'chain', '--time', '12', '--live', '--port', '0', '--no-report');
  const {url} = await server.place;
  const {page, complaints} = await open(url);
  const first = await ask(page, () => ({frames: window.avbdViewer.recording.frames, time: window.avbdViewer.time}));
  await page.waitForFunction((before) => window.avbdViewer.recording.frames > before + 20, first.frames, {timeout: 30000});
  assert.ok(await ask(page, () => window.avbdViewer.time) > first.time, 'the page stays at the end');
  await page.waitForFunction(() => window.avbdViewer.finished, null, {timeout: 60000});
  assert.ok(Math.abs(await ask(page, () => window.avbdViewer.time) - 12) < 0.02);
  const reported = () => [...document.querySelectorAll('.panel th')].some((cell) => cell.textContent === 'hash');
  await page.waitForFunction(reported, null, {timeout: 10000});
  server.child.kill('SIGINT');
  const {status, text} = await server.ended;
  assert.equal(status, 0, text);
  assert.deepEqual(complaints, []);
  await page.close();
}

try {
  const recorded = await start('run', 'chain', '--time', '1', '--record', 'chain.avbd', '--no-report').ended;
  assert.equal(recorded.status, 0, recorded.text);
  await testFinished('chain.avbd');
  const longer = await start('run', 'chain', '--time', '16', '--record', 'long.avbd', '--no-report').ended;
  assert.equal(longer.status, 0, longer.text);
  await testPath('long.avbd');
  await testGrowing();
  const soft = await start('run', 'soft_cubes', '--time', '0.5', '--record', 'soft.avbd', '--no-report').ended;
  assert.equal(soft.status, 0, soft.text);
  await testSoft('soft.avbd');
  console.log('all passed');
} finally {
  for (const child of running) child.kill('SIGKILL');
  await browser.close();
  rmSync(work, {recursive: true, force: true});
}
