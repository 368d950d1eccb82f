// The three data elements of the page. Each may be missing or damaged without the others.
import type { MapText, Page, Report } from './contract';
import { bytesOfBase64, decodePlanes, gunzip } from './decode';
import { type PointMap, pointMap } from './point_map';

function textOf(id: string): string {
  const element = document.getElementById(id);
  if (!element?.textContent) {
    throw new Error(`This page holds no data (element ${id} is missing). cmap_eval --html writes a page with data.`);
  }
  return element.textContent;
}

function parse(id: string): unknown {
  const text = textOf(id);
  try {
    return JSON.parse(text);
  } catch (error) {
    throw new Error(`The data of this page is damaged: ${id}: ${String(error)}`);
  }
}

export function reportText(): string {
  return textOf('cmap-report');
}

export function readReport(): Report {
  const report = parse('cmap-report') as Report;
  if (typeof report?.schema !== 'string' || !report.schema.startsWith('cmap.report/') || !report.metrics) {
    throw new Error('The data of this page is damaged: it holds no report of cmap_eval.');
  }
  return report;
}

export function readPage(): Page {
  const page = parse('cmap-page') as Page;
  if (!Array.isArray(page?.metrics) || !Array.isArray(page.maps) || !Array.isArray(page.layers)) {
    throw new Error('The data of this page is damaged: cmap-page is incomplete.');
  }
  return page;
}

export async function readMaps(maps: MapText[]): Promise<PointMap[]> {
  const text = textOf('cmap-points');
  try {
    const planes = decodePlanes(await gunzip(bytesOfBase64(text)), maps);
    return maps.map((map, i) => pointMap(map, planes[i]));
  } catch (error) {
    throw new Error(`The points of this page are damaged: ${error instanceof Error ? error.message : String(error)}`);
  }
}
