// What the page's JSON holds (data.rs writes it), for the check of types alone.

/** Offset, scale and base64 of 16-bit numbers, low byte first; 65535 is nothing. */
type Column = [number, number, string];
type V3 = [number, number, number];
/** w, x, y, z. */
type Q4 = [number, number, number, number];

interface MeshData { name: string; v: Column; t: Column }
interface LinkData {
  parent: number; p: V3; q: Q4; axis: V3; by: string | null; factor: number; look: string; standIn: boolean;
  thrust: string | null; mesh: MeshData[];
}
interface RobotData { links: LinkData[]; fixed: boolean; radius: number; lift: number; told: string }
interface MotionData { x: Column; y: Column; z: Column; t: Column; q: Column[] | null; channels: { [name: string]: Column } }
interface LineData { name: string; channel: string; scale: number }
interface FlownData extends MotionData {
  d: Column; judged: Column; v: Column; leg: Column | null; panels: { title: string; lines: LineData[] }[];
}
interface RunData { run: number; t: Column; d: Column; x: Column; y: Column; z: Column }
interface CaseData {
  id: string; status: string; told: string; at: number; mark: string | null; fails: boolean; waypoints: V3[]; planned: MotionData; flown: FlownData | null;
  runs: RunData[]; obstacles: MeshData[];
}
interface MetricData { name: string; unit: string; limit: number | null; lower: boolean; values: Column; random: Column | null }
interface ReliefData { low: [number, number]; step: number; rows: number; columns: number; z: Column; shade: Column }
interface ReportDataOfPage {
  beside: string; shown: string; folder: string | null; unit: string; limit: number | null; digits: number; done: string; low: V3; size: V3; relief: ReliefData | null;
  obstacles: MeshData[]; obstaclesTold: string; robot: RobotData | null; open: number; asked?: string; cases: CaseData[];
  ids: string[]; status: string[]; metrics: MetricData[]; draws: { name: string; values: Column }[];
}
interface Theme { [name: string]: string }
interface Motion { t: Float64Array; p: V3[]; q: Q4[] | null; channels: { [name: string]: Float64Array } }
interface Flown extends Motion { d: Float64Array; judged: Float64Array; v: Float64Array; leg: Float64Array | null }
interface Case {
  data: CaseData; planned: Motion; flown: Flown | null; runs: { run: number; t: Float64Array; d: Float64Array; p: V3[] }[];
}
