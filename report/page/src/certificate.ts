// What is proved of a declared pose, for people: docs/method.md says what it means.
import type { Certificate, Trial, Verification } from "./data";
import { el } from "./elements";
import { fixed, percent, significant } from "./numbers";

/** Contact of the declared pose less the most that any other may have, in points of 100. */
function lead({ contact, at_most }: Certificate): number {
  return 100 * (contact - at_most);
}

export function certificateSentence(certificate: Certificate): string {
  const { contact, at_most, distance_m, rotation_deg } = certificate;
  const proved =
    `${percent(contact)} of the local map's points are in contact at the declared pose; ` +
    `no pose more than ${Number(distance_m.toFixed(2))} m or ${Number(rotation_deg.toFixed(1))}° away has more than ${percent(at_most)}.`;
  return lead(certificate) < 0 ? `${proved} That bound is no lower, so a pose elsewhere may fit as well.` : proved;
}

/** Results list no more rivals of a step, the best ones. */
const mostRivals = 5;

function rivalsSentence({ rivals, score, margin }: Verification): string {
  if (rivals.length === 0) return "No rival was found.";
  const best = rivals[0];
  const place = `${fixed(best.pose.x, 1)} m, ${fixed(best.pose.y, 1)} m`;
  const number = `${rivals.length < mostRivals ? "" : "At least "}${rivals.length}`;
  const found = `${rivals.length === 1 ? "One rival was" : `${number} rivals were`} found; the best, at ${place}, has score ${significant(best.score)}`;
  const limit = significant(score - margin);
  // A pose is refuted for other reasons, too.
  return best.score >= score - margin
    ? `${found}, and ${limit} is enough to refute a pose of score ${significant(score)}.`
    : `${found}, less than the ${limit} that would refute the declared pose (score ${significant(score)}).`;
}

/** Of a step whose declaration was verified. */
export function verificationSentence(verification: Verification): string {
  const { certificate, refuted, goes_on } = verification;
  if (goes_on) return "Not declared yet: the search of the whole map goes on.";
  const head = refuted ? "Refuted. " : "";
  const proved = certificate ? certificateSentence(certificate) : "The search of the whole map was given up, so nothing is proved.";
  return `${head}${proved} ${rivalsSentence(verification)}`;
}

/** What the step's verification says; else the certificate that the trial's declaration has; null without either. */
export function certificateNote(trial: Trial, step: number, isOpen: boolean): HTMLElement | null {
  const verification = trial.columns?.verifications?.find((v) => v.step === step);
  const certificate = verification ? verification.certificate : trial.certificate;
  if (!verification && !certificate) return null;
  const declared = trial.steps === undefined ? "" : `, of step ${trial.steps - 1}`;
  const name = verification ? (verification.certificate && !verification.refuted ? "certificate" : "verification") : `certificate of the trial${declared}`;
  const text = verification ? verificationSentence(verification) : certificate ? certificateSentence(certificate) : "";
  return el(
    "details",
    { class: `certificate${verification?.refuted ? " refuted" : ""}`, open: isOpen },
    el("summary", {}, el("strong", {}, name), certificate && `: ${leadText(certificate)}`),
    el("div", { class: "proof" }, certificate && leadOf(certificate), el("p", {}, text)),
  );
}

const leadText = (certificate: Certificate): string => `${lead(certificate) < 0 ? "−" : "+"}${fixed(Math.abs(lead(certificate)), 1)} points`;

/** The number, over a bar of the two contacts. */
function leadOf(certificate: Certificate): HTMLElement {
  const { contact, at_most } = certificate;
  const wide = (share: number): string => `width: ${(100 * Math.min(Math.max(share, 0), 1)).toFixed(1)}%`;
  return el(
    "figure",
    { title: "Contact of the declared pose less the most that any pose elsewhere has, in points of 100" },
    el("figcaption", {}, leadText(certificate)),
    el("span", { class: "contact", title: `here ${percent(contact)}` }, el("i", { style: wide(contact) })),
    el("span", { class: "contact elsewhere", title: `elsewhere at most ${percent(at_most)}` }, el("i", { style: wide(at_most) })),
  );
}
