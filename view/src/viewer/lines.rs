//! What the viewer writes over the picture.

use host_tools::compare::Comparison;

use super::{Shown, Viewer};
use crate::chip::{Effort, TARGETS};
use crate::overlay::HELP;

impl Viewer {
    /// The lines over the picture.
    pub(super) fn lines(&self) -> Vec<String> {
        if self.shown == Shown::Nothing {
            return Vec::new();
        }
        let mut lines = vec![self.picture_line()];
        if let Some(failure) = &self.facts.failure {
            lines.push(failure.clone());
        }
        if self.canvas.full().is_some() {
            lines.push(match self.facts.comparison.as_deref() {
                Some(comparison) => error_line(comparison),
                None => "error: being worked out".into(),
            });
        }
        if self.setup.is_chip {
            lines.extend(self.chip_lines());
        }
        lines.extend(self.message.clone());
        if self.shown == Shown::Help {
            lines.extend(HELP.map(str::to_owned));
        }
        lines
    }

    /// Kernel, size and time.
    fn picture_line(&self) -> String {
        let [width, height] = self.canvas.size();
        let begin = format!("{} {width}x{height}", self.kernel());
        if let (Some(samples), None) = (self.facts.samples, self.facts.full_after) {
            return format!("{begin}: {samples} samples and more");
        }
        let Some(took) = self.facts.took else { return begin };
        let milliseconds = 1000.0 * took.seconds;
        match (self.wish.and_then(|wish| wish.draft), self.facts.full_after) {
            (Some([width, height]), _) => {
                let rate = self.rate.frames_a_second();
                let rate = rate.map_or_else(String::new, |rate| format!(", {rate:.1} frames/s"));
                format!("{begin} from {width}x{height}: {milliseconds:.0} ms{rate}")
            }
            (None, Some(after)) => {
                format!("{begin}: {milliseconds:.0} ms, full {:.0} ms after stopping", 1000.0 * after)
            }
            (None, None) => format!("{begin}: being drawn"),
        }
    }

    /// Board, and how long it takes.
    fn chip_lines(&self) -> Vec<String> {
        let target = &TARGETS[self.setup.board];
        let begin = format!("{} ({}) at {} MHz", target.board.name, target.board.chip, target.clock_mhz);
        match &self.facts.effort {
            Some(Ok(effort)) => {
                let how = match target.model {
                    Some(model) => format!("cycles modelled as a {model}'s"),
                    None => "a cycle an instruction at the least".into(),
                };
                let Effort { instructions, seconds, blob_bytes, is_same, .. } = effort;
                let same = if *is_same { "the chip's picture, bit for bit" } else { "the chip's picture DIFFERS" };
                vec![
                    format!("{begin}: {seconds:.2} s a frame"),
                    format!("{instructions} instructions, counted; {how}"),
                    format!("scene of {blob_bytes} bytes; {same}"),
                ]
            }
            Some(Err(reason)) => vec![begin, format!("no time: {reason}")],
            None => {
                let known = self.known.filter(|(place, _)| *place == [self.setup.board, self.setup.kernels[1]]);
                let guess = known.zip(self.facts.took).map(|((_, a_ray), took)| a_ray * took.rays as f64);
                let time = guess.map_or("time unknown".into(), |seconds| {
                    format!("about {seconds:.1} s a frame, by the rays of the last count")
                });
                let counting = if self.canvas.full().is_some() { "; counting" } else { "" };
                vec![format!("{begin}: {time}{counting}")]
            }
        }
    }
}

fn error_line(comparison: &Comparison) -> String {
    let psnr = comparison.psnr.map_or("equal pictures".into(), |psnr| format!("PSNR {psnr:.1} dB"));
    let Comparison { over_1, over_64, .. } = comparison;
    format!("error against f64: {psnr}, {over_1} pixels over 1, {over_64} over 64")
}
