/* The samples of one curve in the browser: a bounded number of them, with every peak.

The same rules as `plots/history.py`: of the older samples only the smallest and the largest of each
span of time are left, and a gap, a NaN, between two samples stays one. */
window.ArmCurveStore = class {
  static CAPACITY = 131072;

  constructor(capacity = ArmCurveStore.CAPACITY) {
    this.capacity = capacity;
    this.times = new Float64Array(Math.min(1024, capacity));
    this.values = new Float32Array(this.times.length);
    this.clear();
  }

  clear() {
    this.length = 0;
  }

  get firstTime() {
    return this.length ? this.times[0] : Infinity;
  }

  push(time, value) {
    if (this.length === this.times.length) this.#makeRoom();
    this.times[this.length] = time;
    this.values[this.length] = value;
    this.length += 1;
  }

  /* The number of samples that are not later than a time. */
  until(time) {
    let low = 0;
    let high = this.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.times[middle] <= time) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  /* The value that the curve has at a time; NaN in a gap, before the begin and after the end. */
  valueAt(time, holds) {
    let index = this.until(time) - 1;
    while (holds && index > 0 && Number.isNaN(this.values[index])) index -= 1;
    return index < 0 ? NaN : this.values[index];
  }

  #makeRoom() {
    if (this.times.length < this.capacity) {
      const size = Math.min(2 * this.times.length, this.capacity);
      const times = new Float64Array(size);
      const values = new Float32Array(size);
      times.set(this.times);
      values.set(this.values);
      [this.times, this.values] = [times, values];
      return;
    }
    this.#thin(Math.floor((3 * this.length) / 4), this.capacity / 8);
  }

  #thin(count, spans) {
    const { times, values } = this;
    const begin = times[0];
    const length = (times[count - 1] - begin) / spans || 1;
    const isKept = new Uint8Array(count);
    let [least, most, span] = [-1, -1, -1];
    for (let index = 0; index < count; index += 1) {
      if (Number.isNaN(values[index])) continue;
      const its = Math.floor((times[index] - begin) / length);
      if (its !== span) {
        if (span >= 0) isKept[least] = isKept[most] = 1;
        [least, most, span] = [index, index, its];
      }
      if (values[index] < values[least]) least = index;
      if (values[index] > values[most]) most = index;
    }
    if (span >= 0) isKept[least] = isKept[most] = 1;
    let written = 0;
    let isGap = false;
    for (let index = 0; index < this.length; index += 1) {
      const isFirstOfGap = !isGap && Number.isNaN(values[index]);
      if (index < count && !isKept[index] && !isFirstOfGap) continue;
      isGap = index < count && isFirstOfGap;
      times[written] = times[index];
      values[written] = values[index];
      written += 1;
    }
    this.length = written;
  }
};
