// SPDX-License-Identifier: MIT
// Rectangles [x, y, width, height] on the wall's canvas, and on the page. Pure.

const kLeast = 16;    // canvas pixels: no window is made smaller
const kInSight = 32;  // canvas pixels of a window that stay on the canvas

const clamp = (value, least, most) => Math.min(Math.max(value, least), Math.max(least, most));

export const same = (a, b) => a.every((value, i) => value === b[i]);
export const contains = ([x, y, width, height], [px, py]) => px >= x && py >= y && px < x + width && py < y + height;
export const touch = (a, b) => a[0] < b[0] + b[2] && b[0] < a[0] + a[2] && a[1] < b[1] + b[3] && b[1] < a[1] + a[3];
export const placeText = ([x, y, width, height]) => `${width}×${height} at ${x}, ${y}`;

/** Some of it stays on a canvas of that size. */
export function moved([x, y, width, height], dx, dy, canvas) {
  return [
    clamp(Math.round(x + dx), Math.min(0, kInSight - width), canvas.width - kInSight),
    clamp(Math.round(y + dy), Math.min(0, kInSight - height), canvas.height - kInSight), width, height];
}

/** By its lower right corner. */
export function resized([x, y, width, height], dx, dy, canvas) {
  return [x, y, clamp(Math.round(width + dx), kLeast, 2 * canvas.width),
      clamp(Math.round(height + dy), kLeast, 2 * canvas.height)];
}

/**
 * Where a canvas rectangle lies in whole pixels of a picture of that size, as walld says of streams; neighbours
 * neither overlap nor gape.
 */
export function scaledRect([x, y, width, height], canvas, picture) {
  const across = edge => Math.round(edge * picture.width / canvas.width);
  const down = edge => Math.round(edge * picture.height / canvas.height);
  return [across(x), down(y), across(x + width) - across(x), down(y + height) - down(y)];
}
