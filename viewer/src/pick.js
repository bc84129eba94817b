// Which cell is under the pointer.

import * as THREE from 'three';

/** The number of the cell in the frame under a point of the page; none where there is none. */
export function cellAt(viewer, clientX, clientY) {
  const { left, top, width, height } = viewer.canvas.getBoundingClientRect();
  viewer.target ??= new THREE.WebGLRenderTarget(1, 1);
  const { camera } = viewer.eye;
  camera.setViewOffset(width, height, clientX - left, clientY - top, 1, 1);
  viewer.renderer.setRenderTarget(viewer.target);
  viewer.renderer.setClearColor(0x000000, 0);
  viewer.renderer.clear();
  const alone = new THREE.Scene();
  viewer.cells.picking(() => {
    alone.add(viewer.cells.group);
    viewer.renderer.render(alone, camera);
  });
  viewer.space.add(viewer.cells.group);
  viewer.renderer.setRenderTarget(null);
  viewer.renderer.setClearColor(viewer.ground, 1);
  camera.clearViewOffset();
  const pixel = new Uint8Array(4);
  viewer.renderer.readRenderTargetPixels(viewer.target, 0, 0, 1, 1, pixel);
  const number = pixel[0] + 256 * pixel[1] + 65536 * pixel[2];
  viewer.dirty();
  return number > 0 ? number - 1 : undefined;
}
