// Numbers and lengths as people read them.
const whole = new Intl.NumberFormat('en');

export const count = (number) => whole.format(number);
/** `noun` in the plural unless there is one: 1 edge, 2 edges. */
export const counted = (number, noun) => `${count(number)} ${noun}${number === 1 ? '' : 's'}`;

/** A number with `digits` that count. */
export function short(number, digits = 4) {
  if (!Number.isFinite(number)) return number > 0 ? '∞' : number < 0 ? '−∞' : '–';
  if (number === 0) return '0';
  const size = Math.abs(number);
  const text = size >= 1e6 || size < 1e-4 ? number.toExponential(digits - 1)
    : Number(number.toPrecision(digits)).toString();
  return text.replace(/e\+?(-?\d+)/, (_, power) => ` · 10${superscript(power)}`).replace(/^-/, '−');
}
const superscript = (power) => [...power].map((each) => '⁰¹²³⁴⁵⁶⁷⁸⁹'[each] ?? '⁻').join('');

export const withUnit = (text, unit, power = 1) => (unit ? `${text} ${unit}${['', '', '²', '³'][power]}` : text);
export const length = (number, unit, digits) => withUnit(short(number, digits), unit);
/** A value and how far off it may be, to as many digits as are proven, nine at most. */
export function proven(value, error, unit, power) {
  const ratio = Math.abs(value) / error;
  const digits = Math.min(Math.max(Math.floor(Math.log10(ratio)) + 1, 2), 9);
  return `${withUnit(short(value, Number.isFinite(digits) ? digits : 9), unit, power)} ± ${short(error, 2)}`;
}
/** One significant digit, for a first suggestion. */
export const round = (number) => Number(number.toPrecision(1));

/** Makes an element with properties and children. */
export function element(tag, properties = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name in made) made[name] = value;
    else made.setAttribute(name, value);
  }
  made.append(...children.filter((each) => each !== null && each !== undefined));
  return made;
}
/** A list of terms and values. Rows whose value is null are left out. */
export function terms(rows) {
  const list = element('dl', { className: 'terms' });
  for (const [term, value, id] of rows)
    if (value !== null && value !== undefined)
      list.append(element('dt', {}, term), element('dd', id ? { id } : {}, value));
  return list;
}
