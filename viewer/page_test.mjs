// The page in headless Chromium: page_test.mjs SAMPLE_PROGRAM CHROMIUM WORK_FOLDER.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {mkdirSync, mkdtempSync, rmSync, statSync} from 'node:fs';
import {join, resolve} from 'node:path';
import {pathToFileURL} from 'node:url';
import {chromium} from 'playwright-core';

const [sample, browserPath, folder] = process.argv.slice(2);
const kSize = {width: 1280, height: 800};
const work = resolve(folder);
mkdirSync(work, {recursive: true});
const profile = mkdtempSync(join(work, 'profile-'));

const browser = await chromium.launchPersistentContext(profile, {
  executablePath: browserPath,
  headless: true,
  viewport: kSize,
  colorScheme: 'dark',
  args: ['--headless', '--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking',
         '--disable-component-update', '--disable-sync', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
});

async function open(kind) {
  const file = join(work, `${kind}.html`);
  execFileSync(sample, [file, kind]);
  const page = await browser.newPage();
  const complaints = [];
  page.on('console', (message) => {
    if (message.type() === 'error' || message.type() === 'warning') complaints.push(message.text());
  });
  page.on('pageerror', (error) => complaints.push(String(error)));
  page.on('request', (request) => {
    if (!/^(file|data|blob):/.test(request.url())) complaints.push(`asked the network for ${request.url()}`);
  });
  await page.goto(pathToFileURL(file).href);
  await page.waitForFunction(() => window.avbdViewer, null, {timeout: 30000});
  await settle(page);
  return {page, complaints, bytes: statSync(file).size};
}

/// Two pictures later all that was asked for is on the screen.
const settle = (page) =>
    page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 30)))));
const ask = (page, question, value) => page.evaluate(question, value);

/// Pixels of a screenshot, decoded by a blank page.
const canvas = await browser.newPage();
async function pixels(page) {
  await settle(page);
  const png = (await page.screenshot()).toString('base64');
  const data = await canvas.evaluate(async (text) => {
    const image = new Image();
    image.src = `data:image/png;base64,${text}`;
    await image.decode();
    const surface = new OffscreenCanvas(image.width, image.height).getContext('2d', {willReadFrequently: true});
    surface.drawImage(image, 0, 0);
    const bytes = surface.getImageData(0, 0, image.width, image.height).data;
    let binary = '';
    for (let i = 0; i < bytes.length; i += 32768) binary += String.fromCharCode(...bytes.subarray(i, i + 32768));
    return btoa(binary);
  }, png);
  const bytes = Buffer.from(data, 'base64');
  return (x, y) => {
    const at = 4 * (Math.round(y) * kSize.width + Math.round(x));
    return [bytes[at], bytes[at + 1], bytes[at + 2]];
  };
}
const apart = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);

/// Bodies that nothing hides show their own colours where they should be, and not the background's: all, or all but
/// `alike`, whose shades happen to be the ground's.
async function checkBodies(page, least, alike = 0) {
  const shown = await pixels(page);
  await ask(page, () => window.avbdViewer.showBodies(false));
  const empty = await pixels(page);
  await ask(page, () => window.avbdViewer.showBodies(true));
  const bodies = await ask(page, () => window.avbdViewer.recording.names.map((name, body) =>
      ({name, body, color: window.avbdViewer.colorOf(body), ...window.avbdViewer.project(body)})));
  const seen = bodies.filter((item) => item.visible && item.front === item.body);
  assert.ok(seen.length >= least, `${seen.length} bodies in front, ${least} expected`);
  const lost = seen.map(({name, x, y}) => ({name, x, y, difference: apart(shown(x, y), empty(x, y))}))
      .filter(({difference}) => difference <= 24)
      .map(({name, x, y, difference}) =>
          `${name} at ${x.toFixed()},${y.toFixed()} differs from the background by ${difference}`);
  assert.ok(lost.length <= alike, lost.join('; '));
  const hues = new Set(seen.map(({x, y}) => shown(x, y).map((value) => value >> 5).join()));
  assert.ok(hues.size >= 5, `only ${hues.size} colours`);
  return seen.length;
}

async function testPlaying(page) {
  await ask(page, () => window.avbdViewer.seek(0));
  await settle(page);
  const before = await ask(page, () => window.avbdViewer.poseOf(20));
  await page.keyboard.press('Space');
  await page.waitForFunction(() => window.avbdViewer.time > 0.25);
  assert.equal(await ask(page, () => window.avbdViewer.playing), true);
  await page.click('.play');
  assert.equal(await ask(page, () => window.avbdViewer.playing), false);
  const stopped = await ask(page, () => window.avbdViewer.time);
  await settle(page);
  assert.equal(await ask(page, () => window.avbdViewer.time), stopped);
  assert.ok(apart(before, await ask(page, () => window.avbdViewer.poseOf(20))) > 0.01, 'bodies move');
}

async function testScrubbing(page) {
  const box = await page.locator('.scrub').boundingBox();
  await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  assert.ok(Math.abs(await ask(page, () => window.avbdViewer.time) - 2) < 0.1, 'the scrub bar seeks');
  await page.keyboard.press('Home');
  for (const [key, frame] of [['ArrowRight', 1], ['ArrowRight', 2], ['ArrowLeft', 1], ['Shift+ArrowRight', 11], ['End', 240]]) {
    await page.keyboard.press(key);
    await settle(page);
    assert.equal(await ask(page, () => window.avbdViewer.frame), frame, key);
  }
  const plot = await page.locator('.plotBox').first().boundingBox();
  await page.mouse.click(plot.x + 56 + (plot.width - 64) / 4, plot.y + 30);
  assert.ok(Math.abs(await ask(page, () => window.avbdViewer.time) - 1) < 0.05, 'a plot seeks');
}

async function testInterpolation(page) {
  const height = async (time) => {
    await ask(page, (at) => window.avbdViewer.seek(at), time);
    await settle(page);
    return (await ask(page, () => window.avbdViewer.poseOf(5)))[2];
  };
  const [a, middle, b] = [await height(6 / 60), await height(6.5 / 60), await height(7 / 60)];
  assert.ok(Math.abs(a - b) > 1e-3, 'the body moves between the frames');
  assert.ok(Math.abs(middle - (a + b) / 2) < 1e-4, 'half way between two frames');
}

/// Of every fourth pixel of the scene.
function differing(a, b) {
  let different = 0;
  for (let y = 100; y < 700; y += 2) {
    for (let x = 10; x < 960; x += 2) different += apart(a(x, y), b(x, y)) > 20;
  }
  return different;
}

/// Each toggle changes the picture and, off again, brings it back.
async function testToggles(page) {
  await ask(page, () => window.avbdViewer.seek(2));
  await page.mouse.move(500, 90);
  const plain = await pixels(page);
  for (const name of ['Contacts', 'Forces', 'Joints', 'Names']) {
    const button = page.locator('.chip', {hasText: name}).first();
    await button.click();
    await page.mouse.move(500, 90);
    const on = await pixels(page);
    assert.ok(differing(plain, on) > 30, `${name} shows something: ${differing(plain, on)}`);
    await button.click();
    await page.mouse.move(500, 90);
    assert.ok(differing(plain, await pixels(page)) < 30, `${name} goes away again`);
  }
  await page.keyboard.press('n');
  await settle(page);
  const labels = await ask(page, () => window.avbdViewer.labels);
  assert.ok(labels > 20 && labels <= 200, `${labels} labels`);
  await page.keyboard.press('n');
}

async function testSelecting(page) {
  const body = await ask(page, () => window.avbdViewer.recording.names.indexOf('ball_heavy'));
  const {x, y} = await ask(page, (index) => window.avbdViewer.project(index), body);
  await page.mouse.click(x, y);
  assert.equal(await ask(page, () => window.avbdViewer.selected), body);
  const text = await page.locator('.selection').innerText();
  assert.match(text, /ball_heavy/);
  assert.match(text, /m\/s/);
  await page.keyboard.press('f');
  await settle(page);
  const near = await ask(page, (index) => window.avbdViewer.project(index), body);
  assert.ok(Math.abs(near.x - 484) < 4, `looking at the body: ${near.x}`);
  await page.keyboard.press('r');
  await page.keyboard.press('Escape');
  assert.equal(await ask(page, () => window.avbdViewer.selected), -1);
}

async function testPyramid() {
  const {page, complaints} = await open('pyramid');
  assert.equal(await page.locator('h1').innerText(), 'Pyramid & pendulum: 55 boxes, 3 capsules, 2 balls');
  assert.match(await page.locator('.panel').innerText(), /6f1e0c93a7d2b845/);
  await ask(page, () => window.avbdViewer.setQuality('2'));
  for (const time of [0, 1, 4]) {
    await ask(page, (at) => window.avbdViewer.seek(at), time);
    const seen = await checkBodies(page, 45);
    console.log(`pyramid at ${time} s: ${seen} bodies where they should be`);
  }
  await ask(page, () => window.avbdViewer.setQuality('3'));  // the rest is about time, not looks
  await testPlaying(page);
  await testScrubbing(page);
  await testInterpolation(page);
  await testToggles(page);
  await testSelecting(page);
  await ask(page, () => window.avbdViewer.toggle('theme', true));
  await checkBodies(page, 45);
  await takePictures(page);
  assert.deepEqual(complaints, []);
  await page.close();
}

async function takePictures(page) {
  await ask(page, () => { window.avbdViewer.setQuality('0'); window.avbdViewer.toggle('theme', false); window.avbdViewer.seek(0.8); });
  await settle(page);
  await page.screenshot({path: join(work, 'dark.png')});
  await ask(page, () => { window.avbdViewer.toggle('theme', true); window.avbdViewer.seek(2.4); });
  for (const name of ['contacts', 'forces', 'joints', 'names']) {
    await ask(page, (which) => window.avbdViewer.toggle(which, true), name);
  }
  await ask(page, () => window.avbdViewer.select(20));
  await settle(page);
  await page.screenshot({path: join(work, 'light.png')});
}

async function testPile() {
  const {page, complaints, bytes} = await open('pile');
  assert.ok(bytes < 15e6, `${bytes} bytes`);
  await ask(page, () => window.avbdViewer.play());
  await page.waitForTimeout(6000);
  const stats = await ask(page, () => ({...window.avbdViewer.stats, calls: window.avbdViewer.drawCalls()}));
  console.log(`pile of 2000, 300 frames: ${(bytes / 1e6).toFixed(1)} MB; our code ${stats.updateMs.toFixed(2)} ms a picture, ` +
      `three.js ${stats.drawMs.toFixed(2)} ms; ${stats.perSecond.toFixed(1)} pictures/s in software at quality ` +
      `${stats.quality}, ${stats.calls} draw calls`);
  assert.ok(stats.calls < 20, `${stats.calls} draw calls`);
  await page.screenshot({path: join(work, 'pile.png')});
  // How far it has played depends on the machine.
  await ask(page, () => { window.avbdViewer.pause(); window.avbdViewer.seek(4); });
  await checkBodies(page, 100, 1);
  assert.deepEqual(complaints, []);
  await page.close();
}

async function testHostile() {
  const {page, complaints} = await open('hostile');
  assert.equal(await ask(page, () => window.broken), undefined);
  assert.equal(await page.title(), `</title><script>window.broken=1</script>"'&`);
  assert.equal(await ask(page, () => window.avbdViewer.recording.names[0]), '</script><script>window.broken=2</script>');
  assert.match(await page.locator('.panel').innerText(), /window\.broken=4/);
  await page.keyboard.press('n');
  await page.keyboard.press('c');
  await page.keyboard.press('Space');
  await ask(page, () => window.avbdViewer.select(2));
  await settle(page);
  await page.screenshot({path: join(work, 'hostile.png')});
  assert.equal(await ask(page, () => window.broken), undefined);
  assert.deepEqual(complaints, []);
  await page.close();
}

/// Every type of shape is drawn, once for all that share it, and shows where it should be.
async function testShapes() {
  const {page, complaints} = await open('shapes');
  await ask(page, () => { window.avbdViewer.setQuality('0'); window.avbdViewer.seek(0); });
  await settle(page);
  const meshes = await ask(page, () => window.avbdViewer.meshes());
  const named = (part) => meshes.filter(({name}) => name.includes(part));
  for (const part of ['sphere', 'tube', 'cap', 'box', 'cylinder', 'cone']) assert.ok(named(part).length > 0, part);
  const surfaces = meshes.filter(({name}) => name.startsWith('surface'));
  // One hull plain, mirrored and rounded, one mesh twice, one terrain.
  assert.deepEqual(surfaces.map(({count}) => count).sort(), [1, 1, 1, 1, 2]);
  assert.ok(surfaces.some(({triangles}) => triangles === 24 * 12 * 2), 'the ring keeps its triangles');
  assert.ok(surfaces.some(({triangles}) => triangles === 39 * 23 * 2), 'the terrain keeps its cells');
  assert.equal(named('trigger').length, 2);
  for (const {name, transparent, triangles} of meshes) {
    assert.equal(transparent, name.includes('trigger'), name);
    assert.ok(triangles >= 12, `${name} has ${triangles} triangles`);
  }
  const seen = await checkBodies(page, 12);
  const box = await ask(page, () => {
    const body = window.avbdViewer.recording.names.indexOf('box');
    return {color: window.avbdViewer.colorOf(body), ...window.avbdViewer.project(body)};
  });
  assert.equal(box.color, 0xff1818);
  const [red, green, blue] = (await pixels(page))(box.x, box.y);
  assert.ok(red > 2 * green && red > 2 * blue, `the box has the colour of its file: ${red} ${green} ${blue}`);
  console.log(`shapes: ${seen} bodies where they should be, ${meshes.length} meshes`);
  await page.screenshot({path: join(work, 'shapes.png')});
  assert.deepEqual(complaints, []);
  await page.close();
}

/// Ropes run over their wheels; the panel names what couples and how far it is from holding.
async function checkCouplings(page) {
  const lines = () => ask(page, () => window.avbdViewer.couplingLines());
  const plain = await pixels(page);
  assert.deepEqual(await lines(), {ropes: 0, wheels: 0, lines: 0});
  await ask(page, () => window.avbdViewer.toggle('joints', true));
  const on = await pixels(page);
  // From a bucket over two wheels to the other; one line of the coupling, two between three bodies.
  assert.deepEqual(await lines(), {ropes: 3, wheels: 2, lines: 1 + 2});
  assert.ok(differing(plain, on) > 100, `ropes show: ${differing(plain, on)}`);
  await page.screenshot({path: join(work, 'couplings.png')});
  const rows = await page.locator('.couplings tr').allInnerTexts();
  assert.equal(rows.length, 3);
  assert.match(rows[0], /^hoist\s+99\.7 µm$/);
  assert.match(rows[1], /^0\.5 door_hinge\.twist − drawer\.x \+ 0\.25 drawer\.x³ = 0\.1\s+-0\.001995$/);
  assert.match(rows[2], /^<b>rail<\/b>\s+0\.25 {2}-0\.000003$/);
  await ask(page, () => window.avbdViewer.seek(1.5));
  await settle(page);
  assert.match((await page.locator('.couplings tr').allInnerTexts())[2], /off$/);
  assert.deepEqual(await lines(), {ropes: 3, wheels: 2, lines: 1});
  await ask(page, () => { window.avbdViewer.toggle('joints', false); window.avbdViewer.seek(0.5); });
  await settle(page);
}

/// Each switch draws its own lines, and only those; a joint that broke shows nothing.
async function testJoints() {
  const {page, complaints} = await open('joints');
  await ask(page, () => { window.avbdViewer.setQuality('2'); window.avbdViewer.seek(0.5); });
  await page.mouse.move(500, 90);
  const lines = () => ask(page, () => window.avbdViewer.jointLines());
  const none = {axes: 0, limits: 0, pointers: 0, forces: 0};
  await settle(page);
  assert.deepEqual(await lines(), none);
  await checkCouplings(page);
  const plain = await pixels(page);
  for (const [name, key, parts] of [['Frames', 'x', ['axes']], ['Limits', 'm', ['limits', 'pointers']], ['Reactions', 'b', ['forces']]]) {
    await page.locator('.chip', {hasText: name}).first().click();
    await page.mouse.move(500, 90);
    const on = await pixels(page), drawn = await lines();
    assert.deepEqual(Object.keys(drawn).filter((part) => drawn[part] > 0), parts, name);
    assert.ok(differing(plain, on) > 100, `${name} shows something: ${differing(plain, on)}`);
    await page.keyboard.press(key);
    assert.ok(differing(plain, await pixels(page)) < 30, `${name} goes away again`);
  }
  assert.deepEqual(await lines(), none);
  for (const name of ['frames', 'limits', 'reactions']) await ask(page, (which) => window.avbdViewer.toggle(which, true), name);
  await settle(page);
  const whole = await lines();
  assert.equal(whole.axes, 3 * 2 * 3);  // three axes of both frames of the hinge, the slider and the cone
  assert.match(await page.locator('.note').innerText(), /joint forces up to 90 N/);
  await page.screenshot({path: join(work, 'joints.png')});
  await ask(page, () => window.avbdViewer.seek(1.5));  // the rope broke
  await settle(page);
  const broken = await lines();
  assert.equal(broken.axes, whole.axes);
  assert.equal(broken.forces, whole.forces - 5);
  const plots = await ask(page, () => window.avbdViewer.plots());
  assert.deepEqual(plots.map(({name}) => name), ['energy', 'penetration', 'gap', 'excess', 'excessAngle']);
  for (const {name, high} of plots.slice(2)) assert.ok(high > 0, name);
  const chips = await page.locator('.plot').allInnerTexts();
  assert.ok(chips.some((text) => /Beyond limits, turning/.test(text)), chips.join());
  assert.deepEqual(complaints, []);
  await page.close();
}

/// The panel tells figures of a soft body that was clicked, by the name of its scene.
async function checkSoftSelection(page) {
  const {x, y, front} = await ask(page, () => window.avbdViewer.project(window.avbdViewer.softs()[0].first + 115));
  assert.ok(front >= 2 && front < 2 + 441, `a point of the cloth is met: ${front}`);
  await page.mouse.click(x, y);
  const text = await page.locator('.selection').innerText();
  assert.match(text, /<b>flag<\/b>\s+cloth, point \d+/);
  assert.match(text, /particles\s+441\s+elements\s+800 triangles/);
  assert.match(text, /largest strain\s+\+\d/);
  await ask(page, () => window.avbdViewer.select(window.avbdViewer.softs()[1].first));
  assert.match(await page.locator('.selection').innerText(), /cube\s+soft body, point 0[^]*volume\s+0\.75 m³, 75\.0 % of rest/);
  await page.keyboard.press('f');
  await settle(page);
  await page.keyboard.press('r');
  await page.keyboard.press('Escape');
}

/// Soft bodies show as surfaces in their colours; mesh, strain and points come and go.
async function testSoft() {
  const {page, complaints} = await open('soft');
  await ask(page, () => { window.avbdViewer.setQuality('2'); window.avbdViewer.seek(1); });
  await page.mouse.move(500, 90);
  const plain = await pixels(page);
  const [cloth, cube] = await ask(page, () => window.avbdViewer.softs());
  assert.deepEqual([cloth.name, cloth.cloth, cloth.points, cloth.triangles, cloth.vertices], ['<b>flag</b>', true, 441, 800, 441]);
  // A vertex for each of the faces that meet at an edge or a corner of the cube.
  assert.deepEqual([cube.name, cube.cloth, cube.points, cube.triangles, cube.vertices], ['cube', false, 125, 192, 6 * 25]);
  assert.ok(cloth.largest > 0.1 && cloth.largest < 0.2, `the cloth is stretched: ${cloth.largest}`);
  assert.ok(Math.abs(cube.largest + 0.25) < 1e-4, `the cube is pressed: ${cube.largest}`);
  assert.ok(Math.abs(cube.volume - 0.75) < 1e-4 && Math.abs(cube.restVolume - 1) < 1e-6, 'the volume is that within the surface');
  const side = await ask(page, () => window.avbdViewer.project(window.avbdViewer.softs()[1].first + 52));
  const [red, green, blue] = plain(side.x, side.y);
  assert.ok(red > 2 * green && red > 2 * blue, `the cube has its own colour: ${red} ${green} ${blue}`);
  for (const [name, key, changed] of [['Mesh', 'w', 500], ['Strain', 's', 3000], ['Points', 'o', 500]]) {
    await page.locator('.chip', {hasText: name}).first().click();
    await page.mouse.move(500, 90);
    const on = await pixels(page);
    assert.ok(differing(plain, on) > changed, `${name} shows something: ${differing(plain, on)}`);
    await page.screenshot({path: join(work, `soft_${name}.png`)});
    if (name === 'Strain') {
      const [r, g, b] = on(side.x, side.y);
      assert.ok(b > r && b > g, `what is pressed is blue: ${r} ${g} ${b}`);
      assert.match(await page.locator('.legend').innerText(), /−25\.0 %\s+0\s+\+25\.0 %/);
    }
    await page.keyboard.press(key);
    assert.ok(differing(plain, await pixels(page)) < 30, `${name} goes away again`);
  }
  const balls = (await ask(page, () => window.avbdViewer.meshes())).filter(({name}) => name.includes('ball'));
  assert.deepEqual(balls.map(({count, visible}) => [count, visible]), [[441 + 98, false]]);
  await page.keyboard.press('n');
  await settle(page);
  assert.equal(await ask(page, () => window.avbdViewer.labels), 3, 'the box and two soft bodies');
  await page.keyboard.press('n');
  assert.match(await page.locator('.title').innerText(), /1 moving {2}· {2}1 static {2}· {2}2 soft/);
  await checkSoftSelection(page);
  assert.deepEqual(complaints, []);
  await page.close();
}

try {
  await testSoft();
  await testJoints();
  await testShapes();
  await testPyramid();
  await testHostile();
  await testPile();
  console.log('all passed');
} finally {
  await browser.close();
  rmSync(profile, {recursive: true, force: true});
}
