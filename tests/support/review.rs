//! One HTML file that shows all pictures which wait for a review: side by side, blinking, with a slider, enlarged.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use base64::Engine as _;

/// Writes `review.html` for the pictures in a folder; takes it away if there are none.
pub(crate) fn write_page(folder: &Path) -> Option<PathBuf> {
    let page = folder.join("review.html");
    let names: BTreeSet<String> = fs::read_dir(folder)
        .ok()?
        .filter_map(|entry| entry.ok()?.file_name().to_str()?.strip_suffix(".actual.png").map(str::to_owned))
        .collect();
    if names.is_empty() {
        let _ = fs::remove_file(&page);
        return None;
    }
    let sections: String = names.iter().map(|name| section(folder, name)).collect();
    let html = include_str!("review.html").replace("<!-- pictures -->", &sections);
    fs::write(&page, html).ok()?;
    Some(page)
}

/// The part of the page that shows one picture, before and after.
fn section(folder: &Path, name: &str) -> String {
    let picture = |kind: &str| match fs::read(folder.join(format!("{name}.{kind}.png"))) {
        Ok(bytes) => {
            let data = base64::engine::general_purpose::STANDARD.encode(bytes);
            format!("<img class=\"{kind}\" alt=\"{kind}\" src=\"data:image/png;base64,{data}\">")
        }
        Err(_) => "<p>no accepted picture yet</p>".to_owned(),
    };
    format!("<section><h2>{name}</h2>{}{}</section>\n", picture("expected"), picture("actual"))
}
