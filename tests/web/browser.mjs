// SPDX-License-Identifier: MIT
// A headless Chromium that does what it is told on stdin, for tests/support/browser.py: browser.mjs PLAYWRIGHT_FOLDER
// CHROMIUM. A line is {"open": CONTEXT_OPTIONS} (a new page in a context of its own) or {"call": "mouse.move",
// "arguments": [...]} (a method of the page); the answer is {"result": ...} or {"error": ...}. {"call": "messages"}:
// errors in the console; "devtools": a command of Chromium's DevTools protocol.
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { createInterface } from 'node:readline';

const [folder, executablePath] = process.argv.slice(2);
const { chromium } = createRequire(join(folder, 'package.json'))('playwright-core');
// Chromium's sandbox does not work for root, and containers have a small /dev/shm.
const browser = await chromium.launch({ executablePath,
    args: ['--no-sandbox', '--disable-dev-shm-usage', '--disable-gpu'] });
let page, devtools, messages;

async function open(options) {
  await page?.context().close();
  page = await (await browser.newContext(options)).newPage();
  devtools = await page.context().newCDPSession(page);
  messages = [];
  page.on('pageerror', error => messages.push(error.stack));
  page.on('console', message => message.type() === 'error' && messages.push(message.text()));
}

function call(path, values) {
  if (path === 'messages') return messages;
  if (path === 'devtools') return devtools.send(...values);
  const names = path.split('.'), method = names.pop();
  const owner = names.reduce((object, name) => object[name], page);
  return owner[method](...values);
}

async function answer(order) {
  if (order.open) return open(order.open);
  const result = await call(order.call, order.arguments ?? []);
  return ['goto', 'reload', 'screenshot'].includes(order.call) ? undefined : result;
}

for await (const line of createInterface({ input: process.stdin })) {
  const reply = await answer(JSON.parse(line)).then(result => ({ result: result ?? null }),
      error => ({ error: error.message }));
  process.stdout.write(`${JSON.stringify(reply)}\n`);
}
await browser.close();
