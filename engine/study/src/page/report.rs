//! The page's text and tables.

use toile_assets::put_line;

use super::drawings::{self, escaped, percent};
use crate::folder::RunReport;
use crate::shares::{DrapedFigures, GarmentSummary, GradingStep, Share, Summary};

const STYLE: &str = "body { font-family: system-ui, sans-serif; background: #fff; color: #222; max-width: 960px; margin: 2em auto; \
padding: 0 1em; }\nsvg { max-width: 100%; height: auto; }\ntable { border-collapse: collapse; margin: 0.7em 0; }\nth, td { padding: 0.2em \
0.7em; text-align: right; border-bottom: 1px solid #ddd; }\nth:first-child, td:first-child { text-align: left; }\n.big { font-size: 1.5em; }\n\
.small { color: #555; font-size: 0.9em; }\nfigure { display: inline-block; margin: 0.3em; text-align: center; font-size: 0.85em; width: 160px; \
vertical-align: top; }\ncode { font-size: 0.85em; overflow-wrap: anywhere; }";

/// Steps that are shown.
const STEPS: usize = 6;

/// A typical person's picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TypicalPicture {
    /// The garment.
    pub garment: String,
    /// Number of the person.
    pub person: i64,
    /// The picture as a `data:` address, or why there is none.
    pub image: Result<String, String>,
}

/// The page of a study: its summary, what its runs took, and pictures of typical people.
pub fn page(summary: &Summary, runs: &[RunReport], pictures: &[TypicalPicture]) -> String {
    let name = escaped(&summary.name);
    let mut html = format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{name}</title>\n<style>\n{STYLE}\n</style>\n</head>\n<body>\n"
    );
    put_line!(html, "<h1>{name}</h1>");
    put_line!(
        html,
        "<p class=\"small\">{} people, {} rows. Every share counts each person's weight; in brackets is its 95 % interval by the bootstrap. \
         A size fits where the ease is comfortable at every zone that the garment is judged by.</p>",
        summary.people,
        summary.rows
    );
    for garment in &summary.garments {
        put_garment(&mut html, garment, pictures);
    }
    put_errors(&mut html, summary);
    put_speed(&mut html, summary, runs);
    html + "</body>\n</html>\n"
}

fn put_table(html: &mut String, heads: &[&str], rows: impl IntoIterator<Item = Vec<String>>) {
    let heads: String = heads.iter().map(|head| format!("<th>{}</th>", escaped(head))).collect();
    put_line!(html, "<table>\n<tr>{heads}</tr>");
    for row in rows {
        let cells: String = row.iter().map(|cell| format!("<td>{}</td>", escaped(cell))).collect();
        put_line!(html, "<tr>{cells}</tr>");
    }
    put_line!(html, "</table>");
}

fn put_garment(html: &mut String, garment: &GarmentSummary, pictures: &[TypicalPicture]) {
    put_line!(html, "<h2>{}</h2>", escaped(&garment.name));
    if garment.people == 0 {
        put_line!(html, "<p>None of these people is of the sex that it is made for.</p>");
        return;
    }
    put_line!(
        html,
        "<p class=\"big\">{} of {} people are fitted by the size recommended to them.</p>",
        percent(&garment.fitted),
        garment.people
    );
    put_line!(html, "<h3>Share of people by size</h3>\n{}", drawings::shares(garment));
    put_line!(
        html,
        "<p class=\"small\">Colour: fitted, with the interval. Grey: the size is the best one, and fails somewhere.</p>"
    );
    put_line!(html, "<h3>Stature and {} girth</h3>\n{}", garment.primary, drawings::map(garment));
    put_line!(
        html,
        "<p class=\"small\">Each dot is a person, in the colour of their size: filled where it fits. The bands hold four of five of each size's people.</p>"
    );
    put_line!(html, "<h3>Where each size fails</h3>");
    let mut heads = vec!["size".to_owned()];
    for zone in &garment.zones {
        heads.extend([format!("{zone} too tight"), format!("{zone} too loose")]);
    }
    heads.push("would fit, of all".to_owned());
    let rows = garment.sizes.iter().filter(|size| size.recommended.share > 0.0).map(|size| {
        let mut row = vec![size.size.clone()];
        for zone in &garment.zones {
            let found = size.failures.iter().find(|f| f.zone == *zone);
            row.extend(
                found.map_or_else(|| ["-".to_owned(), "-".to_owned()], |f| [percent(&f.tight), percent(&f.loose)]),
            );
        }
        row.push(percent(&size.would_fit));
        row
    });
    put_table(html, &heads.iter().map(String::as_str).collect::<Vec<_>>(), rows);
    put_line!(html, "<p class=\"small\">Of the people to whom the size is recommended.</p>");
    put_line!(html, "<h3>Which grading step would help most</h3>");
    let helpful = garment.steps.iter().filter(|step| step.gain.share > 0.0).take(STEPS);
    put_table(html, &["change", "more people fitted"], helpful.map(|step| vec![change(step), points(&step.gain)]));
    put_line!(
        html,
        "<p class=\"small\">Each step between two sizes made 10 mm larger or smaller at one zone, everything larger moved with it, and every person given the best size anew.</p>"
    );
    if let Some(draped) = &garment.draped {
        put_physics(html, draped);
    }
    put_line!(html, "<h3>Does the number of people do?</h3>\n{}", drawings::convergence(garment));
    let of = |person: i64| pictures.iter().find(|p| p.garment == garment.name && p.person == person);
    if garment.typical.iter().any(|t| of(t.person).is_some()) {
        put_line!(html, "<h3>Typical people</h3>\n<div>");
        for person in &garment.typical {
            let [chest, waist, hip] = person.girths_mm.map(|mm| format!("{mm:.0}"));
            let image = match of(person.person).map(|p| &p.image) {
                Some(Ok(image)) => {
                    format!("<img src=\"{image}\" width=\"150\" height=\"300\" alt=\"person {}\">", person.person)
                }
                Some(Err(why)) => escaped(why),
                None => String::new(),
            };
            let fits = if person.fits { "fits" } else { "fails somewhere" };
            put_line!(
                html,
                "<figure>{image}<figcaption>{:.0} % of people<br>{:.0} mm; {chest} / {waist} / {hip}<br>size {}: {fits}</figcaption></figure>",
                person.share * 100.0,
                person.stature_mm,
                escaped(&person.size)
            );
        }
        put_line!(
            html,
            "</div>\n<p class=\"small\">The middles of ten clusters of bodies: stature; chest / waist / hip girth (mm).</p>"
        );
    }
}

fn change(step: &GradingStep) -> String {
    let (word, mm) = if step.change_mm > 0.0 { ("larger", step.change_mm) } else { ("smaller", -step.change_mm) };
    match &step.from {
        Some(from) => format!("{}: the step from {from} to {} {mm:.0} mm {word}", step.zone, step.to),
        None => format!("{}: all sizes {mm:.0} mm {word}", step.zone),
    }
}

fn points(gain: &Share) -> String {
    format!("{:+.1} points ({:+.1} to {:+.1})", gain.share * 100.0, gain.low * 100.0, gain.high * 100.0)
}

fn put_physics(html: &mut String, draped: &DrapedFigures) {
    put_line!(html, "<h3>Sizes by girths beside sizes by physics</h3>");
    let rows = [
        ("people of whom a size without a pull was found", draped.judged.to_string()),
        ("physics and girths agree", percent(&draped.agrees)),
        ("physics takes a smaller size", percent(&draped.smaller)),
        ("physics takes a larger size", percent(&draped.larger)),
        ("something pulls in the recommended size", percent(&draped.pulls)),
        ("try-ons that were simulated", draped.try_ons.to_string()),
        ("garments that could not be laid on a person", draped.troubles.to_string()),
    ];
    put_table(html, &["", "draped"], rows.into_iter().map(|(name, value)| vec![name.to_owned(), value]));
    put_table(
        html,
        &["zone", "ease as worn less ease by girths (mm)", "its deviation"],
        draped
            .worn_less_girths_mm
            .iter()
            .map(|(zone, [mean, sd])| vec![zone.clone(), format!("{mean:+.1}"), format!("{sd:.1}")]),
    );
    put_line!(
        html,
        "<p class=\"small\">By physics the size is the smallest of those draped (the recommended one and its neighbours, if nothing else was asked \
         for) in which no zone is stretched beyond what is comfortable in the fabric. It knows nothing of how loose a garment is meant to be, so that \
         it is a lower bound. Strain at the 99th percentile: {:.1} % in the median, {:.1} % at most.</p>",
        draped.strain_p99 * 100.0,
        draped.worst_strain_p99 * 100.0
    );
    if draped.compared > 0 {
        let [mean, p99, ease] = draped.unsettled_mm;
        put_line!(
            html,
            "<p class=\"small\">Against garments sewn up around the same bodies and fully settled ({} try-ons, medians): cloth {mean:.1} mm off in the mean, {p99:.1} mm at the 99th percentile, \
             ease {ease:.1} mm; in {} of them other zones pull.</p>",
            draped.compared,
            draped.verdicts_changed
        );
    }
}

fn put_errors(html: &mut String, summary: &Summary) {
    put_line!(html, "<h2>How true the answer is</h2>");
    let rows = summary.garments.iter().filter(|g| g.people > 0).map(|g| {
        vec![
            g.name.clone(),
            percent(&g.fitted),
            percent(&g.fitted_as_seen),
            percent(&g.other_size_as_seen),
            percent(&g.fitted_by_table),
            percent(&g.table_agrees),
        ]
    });
    let heads = [
        "garment",
        "fitted, true measures",
        "fitted, measures as seen",
        "another size as seen",
        "fitted by the size table",
        "table agrees",
    ];
    put_table(html, &heads, rows);
    let sigma: Vec<String> =
        summary.sensor_sigma_mm.as_object().into_iter().flatten().map(|(name, mm)| format!("{name} {mm} mm")).collect();
    put_line!(
        html,
        "<p class=\"small\">People are drawn, so that their true measures are known. As seen: each measure with a normal error of its own ({}). The size \
         table takes who is in the range of the one girth that designates sizes, whatever the garment's own girths are; who is in none is not fitted.</p>",
        escaped(&sigma.join(", "))
    );
}

fn put_speed(html: &mut String, summary: &Summary, runs: &[RunReport]) {
    put_line!(html, "<h2>Speed, versions, hashes</h2>");
    let rows = runs.iter().map(|run| {
        let minutes = (run.seconds / 60.0).max(1e-9);
        let done = run.rows - run.kept;
        let draped = if run.draped > 0 { format!("{:.1}", run.draped as f64 / minutes) } else { "-".to_owned() };
        vec![
            format!("{}/{}", run.shard, run.of),
            done.to_string(),
            run.workers.to_string(),
            format!("{:.1}", run.seconds),
            format!("{:.0}", done as f64 / minutes),
            draped,
        ]
    });
    put_table(html, &["shard", "rows", "workers", "seconds", "rows a minute", "simulated try-ons a minute"], rows);
    put_line!(
        html,
        "<p>toile {}, study <code>{}</code></p>",
        escaped(&summary.version),
        escaped(&summary.study_sha256)
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_needs_nothing_from_elsewhere_and_writes_signs_out() {
        let summary = Summary {
            name: "a < b".into(),
            version: "0".into(),
            study_sha256: "00".into(),
            people: 0,
            rows: 0,
            sensor_sigma_mm: serde_json::json!({ "chest": 24.0 }),
            garments: Vec::new(),
        };
        let html = page(&summary, &[], &[]);
        assert!(html.contains("<h1>a &lt; b</h1>") && html.contains("chest 24.0 mm"), "{html}");
        assert!(!html.contains("<script") && !html.contains("href=") && !html.contains("src=\"http"));
    }
}
