//! The contact sheet: the reference's picture, and each kernel's with how it differs.

use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::{Markup, html};

use crate::compare::difference;
use crate::picture::Picture;
use crate::report::row::Study;

use super::context::{Context, Drawn, drawn, grouped, setting};
use super::figures::scene_class;
use super::metric::percent_text;
use super::study::unvaried;

/// How many times as bright as it is a difference is shown.
pub(super) const GAIN: u8 = 8;

/// All scenes. A picture that cannot be read is named in its place, with the reason.
pub(super) fn sheet(context: &Context<'_>, folder: &Path) -> Markup {
    let scenes = context.scenes.iter().enumerate().flat_map(|(index, scene)| {
        let rows = context.rows(Study::Kernels, scene);
        let groups = grouped(&rows, |point| unvaried(&setting(point)));
        groups.iter().map(|(_, rows)| of_setting(index, &drawn(rows), folder)).collect::<Vec<_>>()
    });
    let scenes: Vec<Markup> = scenes.collect();
    html! { @for scene in &scenes { (scene) } }
}

fn of_setting(index: usize, rows: &[Drawn<'_>], folder: &Path) -> Markup {
    let Some((first, measured)) = rows.first() else { return html! {} };
    let mut kernels: Vec<Drawn<'_>> = Vec::new();
    for &row in rows {
        // The same picture on every machine.
        if !kernels.iter().any(|known| known.0.kernel == row.0.kernel) {
            kernels.push(row);
        }
    }
    let [width, height] = first.size;
    let truth = Picture::read_png(&folder.join(&measured.truth)).map_err(|error| error.to_string());
    let class = format!("sheet {}", scene_class(index));
    html! {
        div class=(class) {
            figure {
                h4 { (first.scene) " at " (width) "x" (height) ": reference" }
                div.pair { (picture(&truth, "the reference")) }
                figcaption { "f64, of the scene as it was given" }
            }
            @for (point, measured) in &kernels { (of_kernel(point, measured, &truth, folder)) }
        }
    }
}

fn of_kernel(
    point: &crate::report::row::Point,
    measured: &crate::report::row::Measured,
    truth: &Result<Picture, String>,
    folder: &Path,
) -> Markup {
    let own = Picture::read_png(&folder.join(&measured.picture)).map_err(|error| error.to_string());
    let apart = match (&own, truth) {
        (Ok(own), Ok(truth)) => difference(own, truth).map_err(|error| error.to_string()),
        (Err(reason), _) | (_, Err(reason)) => Err(reason.clone()),
    };
    let apart = apart.map(|mut apart| {
        for channel in apart.pixels_mut().as_flattened_mut() {
            *channel = channel.saturating_mul(GAIN);
        }
        apart
    });
    html! {
        figure {
            h4 { (point.kernel) }
            div.pair {
                (picture(&own, &point.kernel))
                (picture(&apart, &format!("how {} differs", point.kernel)))
            }
            figcaption { "over 64: " (percent_text(measured.error.over_64, point)) }
        }
    }
}

fn picture(picture: &Result<Picture, String>, what: &str) -> Markup {
    let png = match picture {
        Ok(picture) => picture.to_png().ok_or("it has no pixels"),
        Err(reason) => Err(reason.as_str()),
    };
    match png {
        Ok(png) => html! { img alt=(what) src={ "data:image/png;base64," (STANDARD.encode(png)) }; },
        Err(reason) => html! { p.missing { "No picture of " (what) ": " (reason) } },
    }
}
