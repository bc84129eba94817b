// What colours show: numbers of cells or atoms on the cells, and a field as a slice, each with its scale.

import * as THREE from 'three';
import { Slice } from './scenery.js';
import { json } from './source.js';
import { decades } from './words.js';

/** The colours of a viewer. */
export class Colours {
  constructor(viewer) {
    this.viewer = viewer;
  }

  async paint(values) {
    const { colour, range } = this.viewer.state;
    if (colour === 'id') {
      this.viewer.cells.colourByIds();
      this.scale = undefined;
      return;
    }
    this.viewer.cells.setMap(this.viewer.scene.maps.values);
    if (colour === 'type' || !values) {
      this.viewer.cells.colour(undefined);
      this.scale = undefined;
      return;
    }
    const about = this.viewer.scene.quantities.find((quantity) => quantity.name === colour);
    const ends = range ?? await this.endsOf(colour, colour === this.viewer.scene.look.colour_by ? this.viewer.scene.look.range : undefined);
    this.viewer.cells.colour(new Float32Array(values), about.of, spread(ends));
    this.scale = { ends, label: about.label, colours: this.viewer.scene.maps.values };
  }

  /** The ends of a scale: those that the document says, else those of all frames. */
  async endsOf(name, given) {
    return given ?? await json(this.viewer.source, `range/${name}`) ?? [0, 1];
  }

  /** Those of a field, whose colours may count in powers of ten. */
  async endsOfField(name) {
    const given = this.viewer.scene.look.field_range;
    const ends = await this.endsOf(name, given && (!this.viewer.state.decades || given[0] > 0) ? given : undefined);
    return this.viewer.state.decades ? decades(ends) : ends;
  }

  /** Shows a species of a field, or none. */
  field(name) {
    this.viewer.state.field = name;
    if (this.slice) {
      this.viewer.space.remove(this.slice.mesh);
      this.slice.dispose();
      this.slice = undefined;
    }
    const field = this.viewer.scene.fields.find((known) => name.startsWith(`${known.name}.`));
    if (!field) {
      this.fieldScale = undefined;
      return;
    }
    this.slice = new Slice(field);
    if (!this.slice.isFlat) this.slice.put(this.viewer.state.axis, this.viewer.state.share);
    this.fieldMap ??= this.map(this.viewer.scene.maps.field);
    this.slice.material.uniforms.map.value = this.fieldMap;
    this.slice.material.uniforms.alpha.value = this.viewer.state.alpha;
    this.slice.material.uniforms.isLog.value = this.viewer.state.decades;
    this.viewer.space.add(this.slice.mesh);
    const species = field.species.find((known) => name === `${field.name}.${known.name}`);
    this.endsOfField(name).then((ends) => {
      this.fieldScale = { ends, label: species.label, colours: this.viewer.scene.maps.field, isLog: this.viewer.state.decades };
      this.viewer.dirty();
    });
  }

  map(colours) {
    const map = new THREE.DataTexture(new Uint8Array(colours.flatMap((colour) => [...colour, 255])), colours.length, 1);
    map.minFilter = THREE.LinearFilter;
    map.magFilter = THREE.LinearFilter;
    map.needsUpdate = true;
    return map;
  }
}

/** Ends that are apart, so that what does not change is in the middle of the scale. */
function spread([low, high]) {
  return high - low > 1e-6 * Math.max(Math.abs(low), Math.abs(high)) ? [low, high] : [low - Math.abs(low || 1), low + Math.abs(low || 1)];
}
