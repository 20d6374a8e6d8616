// A 3D view that costs nothing: what the page draws is counted, not drawn. Where no graphics card
// is, a processor would draw for seconds, and the tests would be about the machine's load.
(() => {
  const drawn = {instances: 0, triangles: 0};
  window.drawn = drawn;
  const constants = window.WebGL2RenderingContext ?? {};
  const numbers = new Map([
    [constants.MAX_TEXTURE_SIZE, 4096],
    [constants.MAX_CUBE_MAP_TEXTURE_SIZE, 4096],
    [constants.MAX_TEXTURE_IMAGE_UNITS, 16],
    [constants.MAX_VERTEX_TEXTURE_IMAGE_UNITS, 16],
    [constants.MAX_COMBINED_TEXTURE_IMAGE_UNITS, 32],
    [constants.MAX_VERTEX_ATTRIBS, 16],
    [constants.MAX_VERTEX_UNIFORM_VECTORS, 1024],
    [constants.MAX_FRAGMENT_UNIFORM_VECTORS, 1024],
    [constants.MAX_VARYING_VECTORS, 16],
    [constants.MAX_UNIFORM_BUFFER_BINDINGS, 24],
    [constants.MAX_SAMPLES, 4],
    [constants.VERSION, "WebGL 2.0"],
    [constants.SHADING_LANGUAGE_VERSION, "WebGL GLSL ES 3.00"],
    [constants.VENDOR, "counted"],
    // A test may name one whose drawing is slow.
    [constants.RENDERER, window.renderer ?? "counted"],
    [constants.SCISSOR_BOX, [0, 0, 1, 1]],
    [constants.VIEWPORT, [0, 0, 1, 1]],
  ]);
  const count = (mode) => {
    if (mode === constants.TRIANGLES) drawn.triangles += 1;
  };
  // Thick lines are one small mesh, drawn once for each.
  const countInstances = () => {
    drawn.instances += 1;
  };
  const answers = {
    getParameter: (name) => numbers.get(name) ?? 0,
    getExtension: () => null,
    getSupportedExtensions: () => [],
    getContextAttributes: () => ({alpha: true, antialias: false}),
    getShaderPrecisionFormat: () => ({precision: 23, rangeMin: 127, rangeMax: 127}),
    getShaderParameter: () => true,
    getProgramParameter: (program, name) =>
      name === constants.ACTIVE_UNIFORMS || name === constants.ACTIVE_ATTRIBUTES ? 0 : true,
    getShaderInfoLog: () => "",
    getProgramInfoLog: () => "",
    checkFramebufferStatus: () => constants.FRAMEBUFFER_COMPLETE,
    isContextLost: () => false,
    getError: () => 0,
    drawElements: count,
    drawArrays: count,
    drawElementsInstanced: countInstances,
    drawArraysInstanced: countInstances,
  };
  const context = (canvas) =>
    new Proxy(answers, {
      get: (_, name) => {
        if (name === "canvas") return canvas;
        if (name === "drawingBufferWidth") return canvas.width;
        if (name === "drawingBufferHeight") return canvas.height;
        if (name in answers) return answers[name];
        if (name in constants) return constants[name];
        return String(name).startsWith("create") ? () => ({}) : () => null;
      },
    });
  const original = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function (kind, options) {
    if (!kind.startsWith("webgl")) return original.call(this, kind, options);
    drawn.antialias = options?.antialias ?? true;
    this.counted ??= context(this);
    return this.counted;
  };
})();
