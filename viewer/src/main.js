// The page of Pseudopod: a result, or a run that goes on, to look at.

import { openSource, json } from './source.js';
import { Viewer } from './viewer.js';

const message = document.getElementById('message');

function say(words, isBad = false) {
  message.textContent = words;
  message.classList.toggle('bad', isBad);
}

/** Waits for the first frame of a run that has recorded none yet. */
function firstFrame(source) {
  return new Promise((done) => {
    const events = new EventSource('events');
    events.onmessage = (event) => {
      const news = JSON.parse(event.data);
      say(news.run?.words || 'The run is being prepared …');
      if (news.frames > 0) {
        events.close();
        done();
      }
    };
  });
}

async function main() {
  say('Loading …');
  const source = await openSource();
  if (source.isServed) await firstFrame(source);
  const [scene, course] = await Promise.all([json(source, 'scene'), json(source, 'course')]);
  const viewer = new Viewer(source, scene, course, say);
  await viewer.start();
  say('');
  window.pseudopod = viewer;
}

main().catch((error) => {
  console.error(error);
  const isOld = !document.createElement('canvas').getContext('webgl2');
  say(isOld ? 'This browser has no WebGL 2, with which the cells are drawn: try a newer one.' : `The page cannot be shown: ${error.message}`, true);
});
