// Pictures and films of what is seen.

/** Lets the reader save some bytes under a name. */
export function save(blob, name) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/** The view and its marks in one canvas. */
export function joined(view, marks, into = document.createElement('canvas')) {
  if (into.width !== view.width) into.width = view.width;
  if (into.height !== view.height) into.height = view.height;
  const context = into.getContext('2d');
  context.drawImage(view, 0, 0);
  context.drawImage(marks, 0, 0, view.width, view.height);
  return into;
}

export function savePicture(view, marks, name) {
  return new Promise((done) => {
    joined(view, marks).toBlob((blob) => {
      save(blob, `${name}.png`);
      done();
    }, 'image/png');
  });
}

/** A film of all frames, as WebM, frame by frame as `show` has drawn them. */
export async function saveFilm(view, marks, name, frames, perSecond, show) {
  const canvas = joined(view, marks);
  const stream = canvas.captureStream(0);
  const [track] = stream.getVideoTracks();
  const recorder = new MediaRecorder(stream, { mimeType: 'video/webm', videoBitsPerSecond: 12_000_000 });
  const parts = [];
  recorder.ondataavailable = ({ data }) => parts.push(data);
  const ended = new Promise((done) => { recorder.onstop = done; });
  recorder.start();
  for (let frame = 0; frame < frames; frame += 1) {
    const wait = new Promise((done) => { setTimeout(done, 1000 / perSecond); });
    await show(frame);
    joined(view, marks, canvas);
    track.requestFrame?.();
    await wait;
  }
  recorder.stop();
  await ended;
  save(new Blob(parts, { type: 'video/webm' }), `${name}.webm`);
}
