// The data of the page: what came out is in it, and so are steps, unless these lie beside it.
import type { Beside, Trial } from "./data";

/** What the program has packed: JSON, compressed, in base64. */
async function unpacked(text: string): Promise<unknown> {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).json();
}

/** The only format that pages read; the program that wrote the data has the page in it. */
const readFormat = 1;

export async function embeddedData<Data extends { format: number }>(): Promise<Data> {
  const element = document.getElementById("glocal-data");
  if (!element) throw new Error("the page holds no data");
  const data = (await unpacked(element.textContent ?? "")) as Data;
  if (data.format !== readFormat) throw new Error(`the data has format ${data.format}, and this page reads ${readFormat}`);
  return data;
}

/** Scripts beside the page call this. */
declare global {
  interface Window {
    glocalChunks?: (chunks: Record<string, string>) => void;
  }
}

/** The steps, local maps and scans of trials, which are taken when they are asked for. */
export class Chunks {
  /** Of scripts that were loaded, until they are taken. */
  private readonly texts = new Map<number, string>();
  private readonly loading = new Map<number, Promise<void>>();
  private readonly scripts = new Map<string, Promise<void>>();

  constructor(private readonly beside: Beside | undefined) {
    window.glocalChunks = (chunks) => {
      for (const [number, text] of Object.entries(chunks)) this.texts.set(Number(number), text);
    };
  }

  /** Gives a trial all that it has left. */
  load(trial: Trial): Promise<void> {
    const { chunk } = trial;
    if (chunk === undefined) return Promise.resolve();
    const loading = this.loading.get(chunk) ?? this.take(trial, chunk).finally(() => this.loading.delete(chunk));
    this.loading.set(chunk, loading);
    return loading;
  }

  private async take(trial: Trial, chunk: number): Promise<void> {
    const content = await unpacked(await this.textOf(chunk));
    Object.assign(trial, content as Pick<Trial, "columns" | "local_map" | "scans">);
    this.texts.delete(chunk);
    delete trial.chunk;
  }

  private async textOf(chunk: number): Promise<string> {
    const element = document.getElementById(`glocal-chunk-${chunk}`);
    if (element) return element.textContent ?? "";
    if (!this.texts.has(chunk) && this.beside) await this.loadScript(this.beside, chunk);
    const text = this.texts.get(chunk);
    if (text === undefined) throw new Error("the page does not hold the steps of this trial");
    return text;
  }

  private loadScript({ folder, hash, first }: Beside, chunk: number): Promise<void> {
    const number = first.filter((begin) => begin <= chunk).length - 1;
    const file = `${folder}/${hash}_${number}.js`;
    let loading = this.scripts.get(file);
    if (!loading) {
      loading = new Promise<void>((resolve, reject) => {
        const script = document.createElement("script");
        script.src = file.split("/").map(encodeURIComponent).join("/");
        script.onload = () => resolve();
        script.onerror = () => {
          this.scripts.delete(file);
          reject(new Error(`steps lie in the folder ${folder} beside this page, where ${hash}_${number}.js is missing`));
        };
        document.head.append(script);
      });
      this.scripts.set(file, loading);
    }
    return loading;
  }
}
