// What stays as it is from step to step, drawn once: without a graphics card a hundred thousand points take longer than all the rest.
import { DepthTexture, Mesh, NearestFilter, PlaneGeometry, Scene, ShaderMaterial, Vector2, WebGLRenderTarget, type Camera, type WebGLRenderer } from "three";

const sheetShaders = {
  vertexShader: "void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }",
  fragmentShader: `
    uniform sampler2D colours;
    uniform sampler2D depths;
    void main() {
      ivec2 at = ivec2(gl_FragCoord.xy);
      float depth = texelFetch(depths, at, 0).r;
      if (depth == 1.0) discard;
      gl_FragColor = texelFetch(colours, at, 0);
      gl_FragDepth = depth;
    }`,
};

export class KeptDrawing {
  /** To be drawn once. */
  readonly scene = new Scene();
  /** Brings its drawing into another scene, colours and depths: what lies behind it there is hidden. */
  readonly sheet: Mesh;
  private readonly target: WebGLRenderTarget;
  private isKept = false;

  constructor(private readonly renderer: WebGLRenderer) {
    const filters = { minFilter: NearestFilter, magFilter: NearestFilter };
    this.target = new WebGLRenderTarget(1, 1, { ...filters, depthTexture: new DepthTexture(1, 1) });
    const uniforms = { colours: { value: this.target.texture }, depths: { value: this.target.depthTexture } };
    this.sheet = new Mesh(new PlaneGeometry(2, 2), new ShaderMaterial({ ...sheetShaders, uniforms }));
    this.sheet.frustumCulled = false;
    this.sheet.renderOrder = -1;
  }

  /** It looks otherwise by now. */
  forget(): void {
    this.isKept = false;
  }

  /** As the camera sees it. */
  draw(camera: Camera): void {
    if (this.isKept) return;
    this.isKept = true;
    const { width, height } = this.renderer.getDrawingBufferSize(new Vector2());
    this.target.setSize(width, height);
    this.renderer.setRenderTarget(this.target);
    this.renderer.render(this.scene, camera);
    this.renderer.setRenderTarget(null);
  }
}
