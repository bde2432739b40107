// SPDX-License-Identifier: GPL-3.0-or-later
// The way to the session: what is asked for and answered, and frames, the newest alone.
"use strict";

const link = { socket: null, between: 0, asked: 0, next: 1, waiting: new Map(), on: {}, header: null, first: null };
link.ready = new Promise((resolve) => { link.first = resolve; });

const tell = (message) => {
  if (link.socket?.readyState === WebSocket.OPEN) link.socket.send(JSON.stringify(message));
};

/** The answer to a message; refused in the words of the session. */
function ask(message) {
  return new Promise((resolve, reject) => {
    if (link.socket?.readyState !== WebSocket.OPEN) return reject(new Error("not connected"));
    const id = link.next++;
    link.waiting.set(id, { resolve, reject });
    tell({ ...message, id });
  });
}

function answer({ id, failed, ...rest }) {
  const waiting = link.waiting.get(id);
  link.waiting.delete(id);
  if (!waiting) return failed && link.on.say(failed);
  if (rest.hash && link.header) Object.assign(link.header, { time: rest.time, hash: rest.hash });
  if (failed) waiting.reject(new Error(failed)); else waiting.resolve(rest);
}

/** A frame's header, and its places and levels as typed arrays. */
function unpackedFrame(buffer) {
  const size = new DataView(buffer).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, size)));
  let at = 4 + size;
  const [bones, skin, particles, obstacles] = header.counts.slice(0, 4).map((count) => {
    const places = new Uint16Array(buffer, at, 3 * count);
    at += places.byteLength;
    return places;
  });
  return { header, bones, skin, particles, obstacles, levels: new Uint8Array(buffer, at, header.counts[4]) };
}

/** When the page is not looked at, a frame in a while keeps the figures. */
function more() {
  const send = () => {
    link.asked = performance.now();
    if (link.socket?.readyState === WebSocket.OPEN) link.socket.send("more");
  };
  const wait = document.hidden ? 500 : link.asked + link.between - performance.now();
  if (wait > 0) setTimeout(send, wait); else requestAnimationFrame(send);
}

function connect(takes = false) {
  const token = location.hash.slice(1);
  link.socket = new WebSocket(`ws://${location.host}/live?token=${token}${takes ? "&take=1" : ""}`);
  link.socket.binaryType = "arraybuffer";
  let told = "";
  link.socket.onmessage = ({ data: message }) => {
    if (typeof message !== "string") {
      const frame = unpackedFrame(message);
      link.header = frame.header;
      link.on.frame(frame);
      link.first();
      return more();
    }
    const text = JSON.parse(message);
    if (text.scene) { link.on.scene(text.scene, text.more); more(); }
    else if (text.busy) told = "Another page poses this body.";
    else if (text.taken) told = "Another page has taken over.";
    else if (text.problem) link.on.say(text.problem);
    else answer(text);
  };
  link.socket.onclose = () => {
    for (const { reject } of link.waiting.values()) reject(new Error("the connection is closed"));
    link.waiting.clear();
    link.on.closed(told || (link.header ? "The session has ended: what was recorded is on disk."
      : "No session answers: open the address that sinew play prints."), Boolean(told));
  };
}
