/* Draws curves over time on a canvas: two axes, gaps, and every peak.

uPlot wants one row of times for all curves. Here each curve has its own, as it comes from a topic of
its own. Of each column of pixels the first, the smallest, the largest and the last value are drawn. */
window.ArmChart = class {
  static LEFT = 48;
  static TOP = 6;
  static BOTTOM = 18;
  static TEXT = "#495057";
  static GRID = "#e9ecef";
  /* Less than this would show the noise of joints at rest. */
  static LEAST_RANGE = { rad: 0.1, m: 0.02, "rad/s": 0.2, "m/s": 0.02, "N m": 0.2, N: 0.2 };

  constructor(canvas) {
    this.canvas = canvas;
    // Without a graphics card a canvas that the processor draws is twenty times as fast.
    this.context = canvas.getContext("2d", { willReadFrequently: true });
    this.area = null;
  }

  /* Draw curves ({store, colour, axis, unit, dashed, holds, hidden}) from one time to another.

  `ranges` has the fixed range of each axis, or null; `now` is where holding curves end, and
  `marked` the time under the pointer, or null. */
  draw(curves, from, to, { ranges = [null, null], now = to, marked = null } = {}) {
    const { canvas, context } = this;
    const ratio = devicePixelRatio || 1;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (!width || !height) return;
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
      [canvas.width, canvas.height] = [Math.round(width * ratio), Math.round(height * ratio)];
    }
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    const shown = curves.filter((curve) => !curve.hidden);
    const sides = [0, 1].map((axis) => shown.filter((curve) => curve.axis === axis));
    const right = sides[1].length ? ArmChart.LEFT : 10;
    const area = {
      left: ArmChart.LEFT, top: ArmChart.TOP, from, to, axes: [],
      width: Math.max(10, width - ArmChart.LEFT - right), height: Math.max(10, height - ArmChart.TOP - ArmChart.BOTTOM),
    };
    area.axes = sides.map((side, axis) => ranges[axis] || this.#range(side, from, to));
    this.area = area;
    context.font = "11px system-ui, sans-serif";
    this.#drawTimes(now);
    sides.forEach((side, axis) => side.length && this.#drawAxis(axis, side));
    context.save();
    context.beginPath();
    context.rect(area.left, area.top, area.width, area.height);
    context.clip();
    for (const curve of shown) this.#drawCurve(curve, now);
    if (marked !== null) this.#mark(shown, marked);
    context.restore();
  }

  x(time) {
    const { left, width, from, to } = this.area;
    return left + ((time - from) / (to - from)) * width;
  }

  y(value, axis) {
    const [low, high] = this.area.axes[axis];
    return this.area.top + (1 - (value - low) / (high - low)) * this.area.height;
  }

  timeAt(x) {
    const { left, width, from, to } = this.area;
    return from + ((x - left) / width) * (to - from);
  }

  valueAt(y, axis) {
    const [low, high] = this.area.axes[axis];
    return low + (1 - (y - this.area.top) / this.area.height) * (high - low);
  }

  static ticks(low, high, most) {
    const raw = (high - low) / Math.max(1, most);
    const power = 10 ** Math.floor(Math.log10(raw));
    const step = [1, 2, 5, 10].map((factor) => factor * power).find((size) => size >= raw);
    const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    const found = [];
    for (let k = Math.ceil(low / step - 1e-9); k * step <= high + step * 1e-9; k += 1) found.push(k * step);
    return found.map((value) => [value, ArmChart.#shown(value, digits)]);
  }

  static #shown(value, digits) {
    const size = Math.abs(value);
    if (size >= 1e5 || digits > 6) return size === 0 ? "0" : value.toExponential(1);
    return value.toFixed(digits).replace(/^-(0(\.0*)?)$/, "$1").replace("-", "\u2212");
  }

  #range(curves, from, to) {
    let [low, high] = [Infinity, -Infinity];
    let least = 0;
    for (const { store, holds, unit } of curves) {
      least = Math.max(least, ArmChart.LEAST_RANGE[unit] || 0);
      const begin = Math.max(0, store.until(from) - (holds ? 1 : 0));
      for (let index = begin, end = store.until(to); index < end; index += 1) {
        const value = store.values[index];
        if (value < low) low = value;
        if (value > high) high = value;
      }
    }
    if (low > high) return [0, 1];
    const middle = (low + high) / 2;
    const range = Math.max(high - low, least, 1e-6 * Math.abs(middle), 1e-9) * 1.08;
    return [middle - range / 2, middle + range / 2];
  }

  #drawTimes(now) {
    const { context, area } = this;
    const bottom = area.top + area.height;
    context.fillStyle = ArmChart.TEXT;
    context.strokeStyle = ArmChart.GRID;
    context.lineWidth = 1;
    context.textAlign = "center";
    context.textBaseline = "top";
    context.beginPath();
    for (const [age, text] of ArmChart.ticks(area.from - now, area.to - now, area.width / 70)) {
      const x = Math.round(this.x(age + now)) + 0.5;
      context.moveTo(x, area.top);
      context.lineTo(x, bottom);
      const place = Math.min(Math.max(x, area.left + 8), area.left + area.width - 8);
      context.fillText(`${text} s`, place, bottom + 4);
    }
    context.rect(area.left + 0.5, area.top + 0.5, area.width - 1, area.height - 1);
    context.stroke();
  }

  #drawAxis(axis, curves) {
    const { context, area } = this;
    const [low, high] = area.axes[axis];
    const isRight = axis === 1;
    const edge = isRight ? area.left + area.width : area.left;
    context.fillStyle = ArmChart.TEXT;
    context.strokeStyle = ArmChart.GRID;
    context.textAlign = isRight ? "left" : "right";
    context.textBaseline = "middle";
    context.beginPath();
    for (const [value, text] of ArmChart.ticks(low, high, area.height / 26)) {
      const y = Math.round(this.y(value, axis)) + 0.5;
      if (!isRight) {
        context.moveTo(area.left, y);
        context.lineTo(area.left + area.width, y);
      }
      context.fillText(text, edge + (isRight ? 4 : -4), y);
    }
    context.stroke();
    const units = [...new Set(curves.map((curve) => curve.unit).filter(Boolean))].join(", ");
    context.save();
    context.translate(isRight ? edge + ArmChart.LEFT - 5 : 7, area.top + area.height / 2);
    context.rotate(-Math.PI / 2);
    context.textAlign = "center";
    context.fillText(units, 0, 0);
    context.restore();
  }

  #drawCurve(curve, now) {
    const { context, area } = this;
    const { store, axis, holds } = curve;
    const { times, values } = store;
    const end = Math.min(store.length, store.until(area.to) + 1);
    let pen = false;
    let [column, first, low, high, last, count] = [NaN, 0, 0, 0, 0, 0];
    const flush = () => {
      if (!count) return;
      const x = column + 0.5;
      if (pen) context.lineTo(x, first);
      else context.moveTo(x, first);
      if (low !== high) {
        context.lineTo(x, low);
        context.lineTo(x, high);
        context.lineTo(x, last);
      } else if (!pen) {
        // A single sample between two gaps is a dot.
        context.lineTo(x + 0.7, first);
      }
      pen = true;
      count = 0;
    };
    const point = (x, y) => {
      if (x !== column) {
        flush();
        [column, first, low, high] = [x, y, y, y];
      }
      if (y < low) low = y;
      if (y > high) high = y;
      last = y;
      count += 1;
    };
    context.strokeStyle = curve.colour;
    context.lineWidth = curve.dashed ? 1.2 : 1.6;
    context.lineJoin = "round";
    context.setLineDash(curve.dashed ? [6, 4] : []);
    context.beginPath();
    let held = NaN;
    for (let index = Math.max(0, store.until(area.from) - 1); index < end; index += 1) {
      const value = values[index];
      if (Number.isNaN(value)) {
        if (holds) continue;
        flush();
        [pen, column] = [false, NaN];
        continue;
      }
      const x = Math.floor(this.x(times[index]));
      const y = this.y(value, axis);
      if (holds && !Number.isNaN(held)) point(x, held);
      point(x, y);
      held = y;
    }
    if (holds && !Number.isNaN(held)) point(Math.floor(this.x(Math.min(now, area.to))), held);
    flush();
    context.stroke();
    context.setLineDash([]);
  }

  #mark(curves, time) {
    const { context, area } = this;
    const x = this.x(time);
    context.strokeStyle = "#868e96";
    context.lineWidth = 1;
    context.beginPath();
    context.moveTo(x, area.top);
    context.lineTo(x, area.top + area.height);
    context.stroke();
    for (const { store, axis, colour, holds } of curves) {
      const value = store.valueAt(time, holds);
      if (Number.isNaN(value)) continue;
      context.fillStyle = colour;
      context.beginPath();
      context.arc(x, this.y(value, axis), 3, 0, 2 * Math.PI);
      context.fill();
    }
  }
};
