// Poses in space, as arrows, cones and rings of the same size from afar as from near.
import { ConeGeometry, CylinderGeometry, DoubleSide, Group, Mesh, MeshBasicMaterial, TorusGeometry, type Vector3 } from "three";

const length = 40; // px

/** An arrow along x and a pin along z, of length 1, so that tilt and roll can be seen. */
const shapes = {
  tip: new ConeGeometry(0.17, 0.4, 16).rotateZ(-Math.PI / 2).translate(0.8, 0, 0),
  shaft: new CylinderGeometry(0.055, 0.055, 0.6, 10).rotateZ(-Math.PI / 2).translate(0.3, 0, 0),
  /** Around arrow and cone, so that they are seen on points of any colour. */
  halo: new ConeGeometry(0.25, 0.56, 16).rotateZ(-Math.PI / 2).translate(0.79, 0, 0),
  sleeve: new CylinderGeometry(0.1, 0.1, 0.62, 10).rotateZ(-Math.PI / 2).translate(0.28, 0, 0),
  pin: new CylinderGeometry(0.035, 0.035, 0.45, 8).rotateX(Math.PI / 2).translate(0, 0, 0.225),
  cone: new ConeGeometry(0.16, 0.5, 12).rotateZ(-Math.PI / 2),
  edge: new ConeGeometry(0.22, 0.68, 12).rotateZ(-Math.PI / 2).translate(-0.01, 0, 0),
  ring: new TorusGeometry(0.55, 0.06, 8, 32),
};

export class Arrows {
  readonly object = new Group();
  private readonly materials = new Map<string, MeshBasicMaterial>();

  /** At a place of the scene. What has a higher order is drawn on top. */
  add(place: Vector3, rotation: [number, number, number, number], parts: (keyof typeof shapes)[], colour: string, order: number): void {
    const arrow = new Group();
    for (const part of parts) {
      const mesh = new Mesh(shapes[part], this.material(colour));
      mesh.renderOrder = order;
      arrow.add(mesh);
    }
    arrow.position.copy(place);
    arrow.quaternion.set(...rotation);
    this.object.add(arrow);
  }

  clear(): void {
    this.object.clear();
  }

  seen(metresPerPixel: (place: Vector3) => number): void {
    for (const arrow of this.object.children) arrow.scale.setScalar(length * metresPerPixel(arrow.position));
  }

  private material(colour: string): MeshBasicMaterial {
    let material = this.materials.get(colour);
    if (!material) this.materials.set(colour, (material = new MeshBasicMaterial({ color: colour, depthTest: false, side: DoubleSide })));
    return material;
  }
}
