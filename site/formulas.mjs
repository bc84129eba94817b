// Formulas, which Markdown must not touch: they leave the text before mdBook sees it and come back, drawn by KaTeX, in its pages.

import katex from 'katex';

const kept = [];
const MARK = /PPFORMULA(\d+)X/g;

/** Text with a function done to what is no code: neither blocks between fences, nor blocks that are indented, nor spans. */
export function outsideCode(text, change) {
  return text.split(/(^(`{3,})[\s\S]*?^\2\s*$|`[^`\n]+`)/m).filter((_, at) => at % 3 !== 2).map((part, at) => (at % 2 ? part : change(part))).join('');
}

/** A text whose formulas are marks. `page` is where its numbered formulas are. */
export function hide(text, page, numbers) {
  const keep = (tex, displayMode) => {
    const number = tex.match(/\\tag\{([a-z_]+\.\d+)\}/)?.[1];
    if (number) numbers.set(number, page);
    kept.push({ tex, displayMode, number, page });
    return `PPFORMULA${kept.length - 1}X`;
  };
  return outsideCode(text, (part) => part
    .replace(/\$\$([\s\S]*?)\$\$/g, (_, tex) => keep(tex.trim(), true))
    .replace(/\\\\\(([\s\S]*?)\\\\\)/g, (_, tex) => keep(tex.trim(), false)));
}

/** A text in which the numbers of formulas lead to them. */
export function refer(text, page, numbers, relative) {
  return outsideCode(text, (part) => part.replace(/(?<!\]|\[)\(([a-z_]+\.\d+)\)(?!\])/g, (whole, number) => (numbers.has(number) ? `[(${number})](${relative(page, numbers.get(number))}#${anchor(number)})` : whole)));
}

const anchor = (number) => `eq-${number.replace('.', '-')}`;

/** HTML with the formulas drawn in place of their marks, and how many they are. */
export function show(html) {
  let count = 0;
  const drawn = html.replace(MARK, (_, at) => {
    const { tex, displayMode, number, page } = kept[at];
    count += 1;
    try {
      const formula = katex.renderToString(tex, { displayMode, throwOnError: true, strict: 'error', trust: false });
      return number ? `<span id="${anchor(number)}">${formula}</span>` : formula;
    } catch (error) {
      throw new Error(`${page}: ${error.message}\n${tex}`);
    }
  });
  return { html: drawn, count };
}

/** The index of the search with the words of formulas in place of their marks. */
export function tell(text) {
  return text.replace(/PPFORMULA(\d+)X/gi, (_, at) => (kept[at].number ? `(${kept[at].number})` : ''));
}
