// Colors of a turntable's video as a browser shows them: node video_test.mjs, with CMAP_RENDER, ffmpeg and what
// tests/report/browser.mjs needs.
import assert from 'node:assert/strict';
import { execFileSync, spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { colorOffset, launch } from '../report/browser.mjs';

const folder = mkdtempSync(join(tmpdir(), 'cmap-video-'));
let browser;
before(async () => {
  browser = await launch();
});
after(async () => {
  await browser.close();
  rmSync(folder, { recursive: true });
});

const red = [255, 0, 0];

/** A red plane of 20 x 20 m. */
function writePlane(name, z) {
  const rows = Array.from({ length: 200 * 200 }, (_, i) => [(i % 200) / 10, Math.floor(i / 200) / 10, z, ...red].join(' '));
  const properties = ['float x', 'float y', 'float z', 'uchar red', 'uchar green', 'uchar blue'];
  const header = ['ply', 'format ascii 1.0', `element vertex ${rows.length}`, ...properties.map((p) => `property ${p}`)];
  const path = join(folder, name);
  writeFileSync(path, [...header, 'end_header', ...rows, ''].join('\n'));
  return path;
}

/** Colors in the middle of the left and of the right half of the video's first frame. */
async function halves(video) {
  const page = await browser.newPage();
  const colors = await page.evaluate(async (base64) => {
    const element = document.createElement('video');
    element.muted = true;
    element.src = `data:video/mp4;base64,${base64}`;
    document.body.append(element);
    const shown = new Promise((done, fail) => {
      element.requestVideoFrameCallback(done);
      element.onerror = () => fail(new Error(element.error.message));
    });
    await Promise.all([element.play(), shown]);
    const [width, height] = [element.videoWidth, element.videoHeight];
    const pen = new OffscreenCanvas(width, height).getContext('2d');
    pen.drawImage(element, 0, 0);
    const at = (x, y) => [...pen.getImageData(Math.round(x), Math.round(y), 1, 1).data].slice(0, 3);
    return [at(width / 4, height / 2), at((3 * width) / 4, height / 2)];
  }, readFileSync(video).toString('base64'));
  await page.close();
  return colors;
}

const skip = spawnSync('ffmpeg', ['-version']).error ? 'no ffmpeg' : false;

for (const size of ['640x480', '1280x720', '1920x1080', '1279x719']) {
  test(`a video of ${size} shows the colors of the picture`, { skip }, async () => {
    const video = join(folder, `${size}.mp4`);
    const pair = [writePlane('reference.ply', 0), writePlane('estimate.ply', 0.05)];
    const panels = ['--panels', 'reference,distance', '--range', '0,0.1'];
    const view = ['--camera', 'top', '--size', size, '--frames', '2']; // from the side its own color would be shaded
    execFileSync(process.env.CMAP_RENDER, [...pair, ...panels, ...view, '--turntable', video, '--quiet']);
    const [color, distance] = await halves(video);
    assert.ok(colorOffset(color, red) <= 4, `red is shown as ${color}`);
    const half = [33, 145, 140]; // viridis(0.5), as published: 0.127568, 0.566949, 0.550556
    assert.ok(colorOffset(distance, half) <= 4, `the middle of the color bar is shown as ${distance}`);
  });
}
