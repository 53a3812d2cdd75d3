// Colours of Okabe and Ito (2008), told apart by people with any colour vision; every line has a
// dash of its own as well. The lighter variants stand on the dark page.

export interface LineStyle {
  /** CSS colour. */
  stroke: string;
  width: number;
  /** Lengths of dash and gap in CSS pixels; empty is solid. */
  dash: number[];
}

const kFamilies = {
  light: {
    signorini: ['#0072B2', '#56B4E9', '#009E73', '#003A5C', '#6A51A3'],
    bullet: ['#D55E00', '#E69F00', '#CC79A7', '#7A3600', '#A8325E'],
    other: ['#000000', '#666666'],
    reference: ['#C4C4BE', '#DAD3B8', '#BFD3CC'],
  },
  dark: {
    signorini: ['#56B4E9', '#A6DBFF', '#2CC79A', '#0F86CC', '#B9A7F0'],
    bullet: ['#F08C3A', '#F0E442', '#E5A3C8', '#C4681F', '#FFC69B'],
    other: ['#FFFFFF', '#AAAAAA'],
    reference: ['#5C6369', '#6B6650', '#4F665E'],
  },
} as const;

const kDashes: Record<keyof typeof kFamilies.light, number[][]> = {
  signorini: [[], [14, 3], [3, 2], [14, 3, 3, 3], [20, 4, 3, 4, 3, 4]],
  bullet: [[7, 5], [2, 4], [10, 4, 2, 4], [5, 2, 5, 8], [2, 2, 8, 4]],
  other: [[1, 3], [12, 6]],
  reference: [[], [16, 4], [8, 8]],
};

function family(engine: string): keyof typeof kFamilies.light {
  if (engine === 'signorini' || engine === 'bullet') return engine;
  return engine === 'closed form' ? 'reference' : 'other';
}

export function isDark(): boolean {
  return matchMedia('(prefers-color-scheme: dark)').matches && !matchMedia('print').matches;
}

/**
 * The style of the `rank`-th line (from 0) of an engine in one plot. A closed form is a broad pale
 * band, so that a line which covers it exactly can be seen to do so.
 */
export function lineStyle(engine: string, rank: number, dark: boolean): LineStyle {
  const name = family(engine);
  const colours = kFamilies[dark ? 'dark' : 'light'][name];
  const dashes = kDashes[name];
  return {
    stroke: colours[rank % colours.length] ?? '#888888',
    width: name === 'reference' ? 7 : name === 'bullet' ? 2 : 1.75,
    dash: dashes[rank % dashes.length] ?? [],
  };
}

/** Contact forces in 3D: Okabe and Ito's green, lighter on the dark page. */
export const kForceColour = { light: '#007a5a', dark: '#2cc79a' } as const;

/** The 3D view of an engine's run. */
export function stageColours(engine: string, dark: boolean): { moving: string; fixed: string; grid: string; point: string } {
  const colours = kFamilies[dark ? 'dark' : 'light'][family(engine)];
  return {
    moving: engine === 'bullet' ? (dark ? '#F08C3A' : '#EE8A2C') : (dark ? '#56B4E9' : '#3C9BDC'),
    fixed: dark ? '#6d747b' : '#a9aca6',
    grid: dark ? '#4a5158' : '#bdbfb9',
    point: dark ? '#ffffff' : colours[3] ?? '#000000',
  };
}
