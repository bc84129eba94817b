// Numbers and times as a reader sees them.

const UNITS = [[1e-3, 1e-6, 'µs'], [1, 1e-3, 'ms'], [600, 1, 's'], [36000, 60, 'min'], [Infinity, 3600, 'h']];

/** The unit of all times of a run that lasts so long, s: its size and name. */
export function unitOf(longest) {
  const [, size, name] = UNITS.find(([below]) => Math.abs(longest) < below);
  return [size, name];
}

/** A time in the unit of the document, or that suits the whole run, as pictures have it. */
export function timeText(time, longest, unit) {
  const most = Math.max(Math.abs(longest), Math.abs(time));
  const [size, name] = unit ?? unitOf(most);
  const digits = most === 0 ? 1 : Math.min(2, Math.max(0, 2 - Math.floor(Math.log10((most / size) * 1.000001))));
  return `t = ${(time / size).toFixed(digits).replace('-', '−')} ${name}`;
}

/** A number with four digits. */
export function short(number) {
  if (number === null || number === undefined || Number.isNaN(number)) return '–';
  const size = Math.abs(number);
  if (size === 0) return '0';
  if (size >= 1e5 || size < 1e-3) {
    const [digits, power] = number.toExponential(3).split('e');
    const raised = String(Number(power)).replace('-', '⁻').replace(/\d/g, (digit) => '⁰¹²³⁴⁵⁶⁷⁸⁹'[digit]);
    return `${Number(digits)}·10${raised}`.replace('-', '−');
  }
  return String(Number(number.toPrecision(4))).replace('-', '−');
}

/** Round numbers between two ends, some so many. */
export function ticks(low, high, count) {
  if (!(high > low)) return [low];
  const rough = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((by) => by * power).find((size) => size >= rough * 0.999);
  const found = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k += 1) found.push(Number((k * step).toPrecision(12)));
  return found;
}

/** Powers of ten between two ends above 0; round numbers where there are less than two. */
export function powers(low, high, count) {
  const found = [];
  for (let k = Math.ceil(Math.log10(low) - 1e-9); k <= Math.log10(high) + 1e-9; k += 1) found.push(10 ** k);
  return found.length > 1 ? found : ticks(low, high, count);
}

/** The ends of a logarithmic scale for what lies between two: above 0, and six decades at most. */
export function decades([low, high]) {
  return high > 0 ? [Math.max(low, high * 1e-6), high] : [0.1, 1];
}

/** Ends of a scale of colours that round-off does not stretch: those of a number that does not change are one. */
export function isConstant([low, high]) {
  return !(high - low > 1e-6 * Math.max(Math.abs(low), Math.abs(high)));
}
