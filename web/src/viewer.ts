// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
import {
  AmbientLight, BufferAttribute, BufferGeometry, DirectionalLight, DoubleSide, FrontSide, Group, LineBasicMaterial, LineSegments, Mesh,
  MeshLambertMaterial, PerspectiveCamera, Plane, Points, PointsMaterial, Raycaster, Scene, Vector2, Vector3, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

import { coloursOf, hasNumbers, isOfCrown, type Colouring } from './colours';
import type { ViewMesh } from './view_mesh';

export type Side = 'front' | 'back' | 'left' | 'right' | 'top' | 'bottom';

/** Three directions of what is looked at, in the scan's frame. */
export interface Directions { up: Vector3; front: Vector3 }

/** What a geometry knows of itself: its mesh, its triangles in full (null: without an index), and coarse ones if they were needed. */
interface Drawn { mesh: ViewMesh; full: BufferAttribute | null | undefined; coarse?: BufferAttribute }

interface Part { tooth: ViewMesh; crown: ViewMesh; group: Group; shown: boolean }

const manyTriangles = 150_000;  // beyond these, everything is drawn coarser while it turns
const coarseCell = 0.7;         // mm
const calm = 250;               // ms after which it is drawn in full again

/** The three-dimensional view. Draws only when something has changed. */
export class Viewer {
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(28, 1, 0.1, 2000);
  private readonly controls: OrbitControls;
  private readonly parts = new Map<number, Part>();
  private readonly gum = new Group();
  private readonly ghosts = new Group();
  private readonly marks = new Group();
  private readonly lamp = new DirectionalLight(0xffffff, 2.2);
  private readonly plane = new Plane(new Vector3(0, 0, -1), 0);
  private directions: Directions = { up: new Vector3(0, 0, 1), front: new Vector3(0, -1, 0) };
  private colouring: Colouring = 'source';
  private isWireframe = false;
  private isSeeThrough = false;
  private isClipping = false;
  private clipShare = 0.5;
  private ghostMeshes: ViewMesh[] = [];
  private triangles = 0;
  private isAsked = false;
  private isCoarse = false;
  private calmTimer = 0;
  private readyTimer = 0;
  private radius = 10;
  private readonly centre = new Vector3();

  constructor(private readonly canvas: HTMLCanvasElement) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.renderer.localClippingEnabled = true;
    this.scene.add(new AmbientLight(0xffffff, 1.1), this.gum, this.ghosts, this.marks, this.camera);
    this.camera.add(this.lamp);
    this.lamp.position.set(0.4, 0.7, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', () => this.draw());
    this.controls.addEventListener('start', () => this.turning(true));
    this.controls.addEventListener('end', () => this.turning(false));
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement ?? canvas);
    canvas.addEventListener('webglcontextrestored', () => this.draw());
    this.resize();
  }

  /** Takes everything away. */
  clear(): void {
    for (const part of this.parts.values()) this.remove(part.group);
    this.parts.clear();
    for (const group of [this.gum, this.ghosts, this.marks]) this.empty(group);
    this.ghostMeshes = [];
    this.draw();
  }

  /** Shows a tooth, in place of what had its number. */
  setTooth(fdi: number, tooth: ViewMesh, crown: ViewMesh): void {
    const old = this.parts.get(fdi);
    if (old) this.remove(old.group);
    const part: Part = { tooth, crown, group: new Group(), shown: old?.shown ?? true };
    this.parts.set(fdi, part);
    this.scene.add(part.group);
    this.build(part);
    this.measureAll();
    this.draw();
  }

  setGum(mesh: ViewMesh | null): void {
    this.empty(this.gum);
    if (mesh) {
      const material = new MeshLambertMaterial({ color: 0xc07a76, side: DoubleSide, transparent: true, opacity: 0.55, depthWrite: false });
      this.gum.add(new Mesh(this.geometry(mesh), this.clipped(material)));
    }
    this.draw();
  }

  showGum(shown: boolean): void {
    this.gum.visible = shown;
    this.draw();
  }

  /** Outlines of further roots; none takes them away. */
  setGhosts(meshes: ViewMesh[]): void {
    this.empty(this.ghosts);
    const colours = [0x7a3db8, 0x1f8a5b];
    meshes.map(rootOf).forEach((mesh, i) => {
      const material = new MeshLambertMaterial({
        color: colours[i % 2] as number, transparent: true, opacity: 0.25, depthWrite: false, side: DoubleSide,
      });
      const lines = new LineBasicMaterial({ color: colours[i % 2] as number, transparent: true, opacity: 0.35 });
      const geometry = this.geometry(mesh);
      this.ghosts.add(new Mesh(geometry, this.clipped(material)));
      this.ghosts.add(new LineSegments(edgesOf(mesh), this.clipped(lines)));
    });
    this.ghostMeshes = meshes;
    this.rebuild();  // the shorter one is within the root, which lets it be seen
    if (meshes.length > 0) this.fit();
  }

  show(fdi: number, shown: boolean): void {
    const part = this.parts.get(fdi);
    if (!part) return;
    part.shown = shown;
    part.group.visible = shown;
    this.draw();
  }

  isShown(fdi: number): boolean {
    return this.parts.get(fdi)?.shown ?? false;
  }

  /** Whether the meshes have the numbers for it. */
  has(colouring: Colouring): boolean {
    for (const part of this.parts.values())
      if (hasNumbers(isOfCrown(colouring) ? part.crown : part.tooth, colouring)) return true;
    return false;
  }

  setColouring(colouring: Colouring): void {
    this.colouring = colouring;
    this.rebuild();
  }

  setWireframe(on: boolean): void {
    this.isWireframe = on;
    this.rebuild();
  }

  setSeeThrough(on: boolean): void {
    this.isSeeThrough = on;
    this.rebuild();
  }

  /** @param share  0 to 1 of the way through, from the side that is looked at; null: no clipping */
  setClip(share: number | null): void {
    const wasClipping = this.isClipping;
    this.isClipping = share !== null;
    this.clipShare = share ?? this.clipShare;
    this.placePlane();
    for (const group of [this.gum, this.ghosts])
      for (const child of group.children) this.clipped((child as Mesh).material as MeshLambertMaterial);
    if (share === null || !wasClipping) this.rebuild();
    this.draw();
  }

  setDirections(directions: Directions): void {
    this.directions = directions;
  }

  /** Everything in view, from where it is looked at. */
  fit(): void {
    this.measureAll();
    const away = this.camera.position.clone().sub(this.controls.target);
    if (away.lengthSq() === 0) away.copy(this.directions.front);
    this.look(away.normalize(), this.camera.up);
  }

  view(side: Side): void {
    const { up, front } = this.directions;
    const left = new Vector3().crossVectors(up, front);
    const from: Record<Side, Vector3> = {
      front, back: front.clone().negate(), left, right: left.clone().negate(), top: up, bottom: up.clone().negate(),
    };
    const isAlongUp = side === 'top' || side === 'bottom';
    this.measureAll();
    // A hair off the axis: turning about an axis that is looked along has no angle to begin with.
    this.look(isAlongUp ? from[side].clone().addScaledVector(front, 1e-3).normalize() : from[side], up);
  }

  turn(right: number, up: number): void {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const axis = this.camera.up.clone().normalize();
    const side = new Vector3().crossVectors(axis, offset).normalize();
    offset.applyAxisAngle(axis, right);
    const turned = offset.clone().applyAxisAngle(side, up);
    if (turned.angleTo(axis) > 0.05 && turned.angleTo(axis) < Math.PI - 0.05) offset.copy(turned);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.draw();
  }

  zoom(factor: number): void {
    const offset = this.camera.position.clone().sub(this.controls.target).multiplyScalar(factor);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.draw();
  }

  /**
   * The point of a surface at a place of the canvas (-1 to 1 each), mm; null beside everything.
   * @param ofScan  a point of what was scanned, gum too: of a tooth's crown the one nearest to where its root was pointed at
   */
  pick(x: number, y: number, ofScan = false): Vector3 | null {
    const ray = new Raycaster();
    this.camera.updateMatrixWorld();  // the view may have been turned since it was drawn
    ray.setFromCamera(new Vector2(x, y), this.camera);
    const groups = [...this.parts.values()].filter((part) => part.shown).map((part) => part.group);
    if (ofScan && this.gum.visible) groups.push(this.gum);
    const meshes = groups.flatMap((group) => group.children);
    for (const hit of ray.intersectObjects(meshes, false)) {
      if (!(hit.object instanceof Mesh)) continue;
      if (this.isClipping && this.plane.distanceToPoint(hit.point) < 0) continue;
      const part = ofScan ? [...this.parts.values()].find(({ group }) => group === hit.object.parent) : undefined;
      return part ? nearestVertex(part.crown, hit.point) : hit.point.clone();
    }
    return null;
  }

  /** Marks measured points, joined by a line if there are two. */
  setMarks(points: Vector3[]): void {
    this.empty(this.marks);
    if (points.length > 0) {
      const geometry = new BufferGeometry().setFromPoints(points);
      const dots = new Points(geometry, new PointsMaterial({ color: 0xd1002f, size: 9, sizeAttenuation: false, depthTest: false }));
      dots.renderOrder = 10;
      this.marks.add(dots);
      if (points.length > 1) {
        const line = new LineSegments(geometry, new LineBasicMaterial({ color: 0xd1002f, depthTest: false }));
        line.renderOrder = 10;
        this.marks.add(line);
      }
    }
    this.draw();
  }

  draw(): void {
    if (this.isAsked) return;
    this.isAsked = true;
    requestAnimationFrame(() => {
      this.isAsked = false;
      if (this.isClipping) this.placePlane();
      this.renderer.render(this.scene, this.camera);
      this.canvas.dataset.triangles = String(this.renderer.info.render.triangles);
      this.canvas.dataset.drawn = String(Number(this.canvas.dataset.drawn ?? '0') + 1);
    });
  }

  private look(from: Vector3, up: Vector3): void {
    const aspect = this.camera.aspect || 1;
    const half = (this.camera.fov * Math.PI) / 360;
    const distance = (1.2 * this.radius) / Math.sin(Math.min(half, Math.atan(Math.tan(half) * aspect)));
    this.camera.up.copy(up);
    this.camera.near = distance / 100;
    this.camera.far = distance * 20;
    this.camera.position.copy(this.centre).addScaledVector(from, distance);
    this.camera.updateProjectionMatrix();
    this.controls.target.copy(this.centre);
    this.controls.update();
    this.draw();
  }

  private rebuild(): void {
    for (const part of this.parts.values()) this.build(part);
    this.draw();
  }

  private build(part: Part): void {
    this.setCoarse(false);
    this.empty(part.group);
    const mesh = isOfCrown(this.colouring) ? part.crown : part.tooth;
    const colours = coloursOf(mesh, this.colouring);
    // Of a closed surface nobody sees the inside, unless it is cut open; drawing it costs software renderers much.
    const isOpen = isOfCrown(this.colouring) || this.isClipping || this.isSeeThrough || this.ghostMeshes.length > 0;
    const material = (): MeshLambertMaterial => new MeshLambertMaterial({
      vertexColors: colours !== null, color: colours ? 0xffffff : 0xd8d2c4, side: isOpen ? DoubleSide : FrontSide, wireframe: this.isWireframe,
    });
    const whole = this.geometry(mesh, colours);
    const isRootGlass = this.ghostMeshes.length > 0;
    if ((this.isSeeThrough || isRootGlass) && !isOfCrown(this.colouring)) {
      const isCrown = (a: number, b: number, c: number): boolean => {
        const source = mesh.perVertex.get('source');
        return source !== undefined && source[a] === 0 && source[b] === 0 && source[c] === 0;
      };
      const glass = (opacity: number): MeshLambertMaterial => {
        const made = material();
        made.transparent = true;
        made.opacity = opacity;
        made.depthWrite = false;
        return made;
      };
      const [crown, rest] = split(whole, mesh.index, isCrown);
      part.group.add(new Mesh(rest, this.clipped(isRootGlass ? glass(0.45) : material())),
                     new Mesh(crown, this.clipped(this.isSeeThrough ? glass(0.3) : material())));
    } else {
      part.group.add(new Mesh(whole, this.clipped(material())));
    }
    part.group.visible = part.shown;
    window.clearTimeout(this.readyTimer);
    this.readyTimer = window.setTimeout(() => this.getReady(), calm);
  }

  /** Works out what is drawn while it turns before somebody turns it. */
  private getReady(): void {
    if (this.triangles <= manyTriangles) return;
    for (const group of [this.gum, ...[...this.parts.values()].map((part) => part.group)])
      for (const child of group.children) {
        const { geometry } = child as Mesh;
        if ((geometry.userData as Drawn).full !== undefined) coarseOf(geometry);
      }
  }

  private geometry(mesh: ViewMesh, colours: ReturnType<typeof coloursOf> = null): BufferGeometry {
    let geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(mesh.position, 3));
    const full = new BufferAttribute(mesh.index, 1);
    geometry.setIndex(full);
    geometry.computeVertexNormals();
    geometry.userData = { mesh, full };
    if (colours?.per === 'vertex') geometry.setAttribute('color', new BufferAttribute(colours.linear, 3));
    if (colours?.per === 'triangle') {
      geometry = geometry.toNonIndexed();
      geometry.userData = { mesh, full: null };
      geometry.computeVertexNormals();
      const spread = new Float32Array(3 * colours.linear.length);
      for (let t = 0; t < colours.linear.length / 3; ++t)
        for (let k = 0; k < 3; ++k) spread.set(colours.linear.subarray(3 * t, 3 * t + 3), 9 * t + 3 * k);
      geometry.setAttribute('color', new BufferAttribute(spread, 3));
    }
    return geometry;
  }

  private clipped<M extends { clippingPlanes: Plane[] | null }>(material: M): M {
    material.clippingPlanes = this.isClipping ? [this.plane] : null;
    return material;
  }

  /** Across the line of sight: what is nearer than the plane is cut away. */
  private placePlane(): void {
    const sight = this.controls.target.clone().sub(this.camera.position).normalize();
    const at = this.centre.clone().addScaledVector(sight, (2 * this.clipShare - 1) * this.radius);
    this.plane.setFromNormalAndCoplanarPoint(sight, at);
  }

  private measureAll(): void {
    const low = new Vector3(Infinity, Infinity, Infinity);
    const high = low.clone().negate();
    const point = new Vector3();
    this.triangles = 0;
    const meshes = [...this.parts.values()].flatMap((part) => [part.tooth, part.crown]);
    for (const part of this.parts.values()) this.triangles += part.tooth.index.length / 3;
    for (const mesh of [...meshes, ...this.ghostMeshes])
      for (let i = 0; i + 2 < mesh.position.length; i += 3) {
        point.fromArray(mesh.position, i);
        low.min(point);
        high.max(point);
      }
    if (low.x > high.x) return;
    this.centre.addVectors(low, high).multiplyScalar(0.5);
    this.radius = Math.max(1, high.distanceTo(low) / 2);
  }

  private turning(on: boolean): void {
    window.clearTimeout(this.calmTimer);
    if (on) this.setCoarse(this.triangles > manyTriangles);
    else this.calmTimer = window.setTimeout(() => this.setCoarse(false), calm);
  }

  /** Fewer pixels and triangles: a processor that does what a graphics card should still follows the mouse then. */
  private setCoarse(on: boolean): void {
    if (on === this.isCoarse) return;
    this.isCoarse = on;
    window.clearTimeout(this.readyTimer);
    this.renderer.setPixelRatio((on ? 0.5 : 1) * Math.min(window.devicePixelRatio, 2));
    for (const group of [this.gum, ...[...this.parts.values()].map((part) => part.group)])
      for (const child of group.children) {
        const { geometry } = child as Mesh;
        const { full } = geometry.userData as Drawn;
        if (full === undefined) continue;  // a part of a tooth, which is drawn as it is
        geometry.setIndex(on ? coarseOf(geometry) : full);
      }
    this.draw();
  }

  private resize(): void {
    const box = (this.canvas.parentElement ?? this.canvas).getBoundingClientRect();
    if (box.width < 1 || box.height < 1) return;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(box.width, box.height, false);
    this.camera.aspect = box.width / box.height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  private empty(group: Group): void {
    for (const child of [...group.children]) {
      group.remove(child);
      const mesh = child as Mesh;
      mesh.geometry.dispose();
      (mesh.material as MeshLambertMaterial).dispose();
    }
  }

  private remove(group: Group): void {
    this.empty(group);
    this.scene.remove(group);
  }
}

/** The geometry in two, by what holds of a triangle's vertices (of the mesh). */
function split(geometry: BufferGeometry, index: Uint32Array, isFirst: (a: number, b: number, c: number) => boolean): [BufferGeometry, BufferGeometry] {
  const first: number[] = [];
  const second: number[] = [];
  const isIndexed = geometry.index !== null;
  for (let i = 0; i + 2 < index.length; i += 3) {
    const [a, b, c] = [index[i] as number, index[i + 1] as number, index[i + 2] as number];
    (isFirst(a, b, c) ? first : second).push(...(isIndexed ? [a, b, c] : [i, i + 1, i + 2]));
  }
  return [first, second].map((part) => {
    const copy = new BufferGeometry();
    for (const [name, attribute] of Object.entries(geometry.attributes)) copy.setAttribute(name, attribute);
    copy.setIndex(part);
    return copy;
  }) as [BufferGeometry, BufferGeometry];
}

function nearestVertex(mesh: ViewMesh, to: Vector3): Vector3 {
  const nearest = to.clone(), vertex = new Vector3();
  let least = Infinity;
  for (let i = 0; i + 2 < mesh.position.length; i += 3) {
    const distance = vertex.fromArray(mesh.position, i).distanceToSquared(to);
    if (distance >= least) continue;
    least = distance;
    nearest.copy(vertex);
  }
  return nearest;
}

/** A tooth without its crown, which all of a crown's teeth have in common. */
function rootOf(mesh: ViewMesh): ViewMesh {
  const source = mesh.perVertex.get('source');
  if (!source) return mesh;
  const index: number[] = [];
  for (let i = 0; i + 2 < mesh.index.length; i += 3) {
    const corners = [...mesh.index.subarray(i, i + 3)];
    if (corners.some((v) => source[v] !== 0)) index.push(...corners);
  }
  return { ...mesh, index: Uint32Array.from(index) };
}

/** A mesh's triangles with all vertices of a cell taken for its first one; most of them fall together and are left out. */
function coarseIndex(mesh: ViewMesh): Uint32Array {
  const { position, index } = mesh;
  const first = new Map<number, number>();
  const stands = new Uint32Array(position.length / 3);
  for (let v = 0; v < stands.length; ++v) {
    const cell = [0, 1, 2].map((k) => Math.floor((position[3 * v + k] as number) / coarseCell) + 2048);
    const key = ((cell[0] as number) * 4096 + (cell[1] as number)) * 4096 + (cell[2] as number);
    if (!first.has(key)) first.set(key, v);
    stands[v] = first.get(key) as number;
  }
  const coarse: number[] = [];
  for (let i = 0; i + 2 < index.length; i += 3) {
    const [a, b, c] = [stands[index[i] as number] as number, stands[index[i + 1] as number] as number, stands[index[i + 2] as number] as number];
    if (a !== b && b !== c && c !== a) coarse.push(a, b, c);
  }
  return Uint32Array.from(coarse);
}

/** By mesh: they are the same in every colour. */
const coarseIndices = new WeakMap<ViewMesh, Uint32Array>();

function coarseOf(geometry: BufferGeometry): BufferAttribute {
  const drawn = geometry.userData as Drawn;
  if (drawn.coarse) return drawn.coarse;
  const { mesh } = drawn;
  let index = coarseIndices.get(mesh);
  if (!index) coarseIndices.set(mesh, index = coarseIndex(mesh));
  if (drawn.full === null) {  // every corner has a vertex of its own: of those at a place the first one stands for it
    const corner = new Uint32Array(mesh.position.length / 3);
    for (let i = mesh.index.length - 1; i >= 0; --i) corner[mesh.index[i] as number] = i;
    index = index.map((vertex) => corner[vertex] as number);
  }
  return drawn.coarse = new BufferAttribute(index, 1);
}

/** Every edge once. */
function edgesOf(mesh: ViewMesh): BufferGeometry {
  const lines: number[] = [];
  const { index } = mesh;
  for (let i = 0; i + 2 < index.length; i += 3)
    for (let k = 0; k < 3; ++k) {
      const a = index[i + k] as number;
      const b = index[i + ((k + 1) % 3)] as number;
      if (a < b) lines.push(a, b);  // within a surface each edge comes in both directions
    }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(mesh.position, 3));
  geometry.setIndex(lines);
  return geometry;
}

export function vector(numbers: readonly [number, number, number]): Vector3 {
  return new Vector3(...numbers);
}

