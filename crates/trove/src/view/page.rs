//! The page itself.

use std::fmt::Write;

use anyhow::Result;

use trove_judge::page::{LOOK, escape};

use super::chunks::Chunks;
use super::table::Table;

const HTML: &str = include_str!("../../../../web/view/page.html");
const CSS: &str = include_str!("../../../../web/view/view.css");
const WORLD: &str = include_str!("../../../../web/view/world.js");
const SHAPES: &str = include_str!("../../../../web/view/shapes.js");
const VIEW: &str = include_str!("../../../../web/view/view.js");
/// What of three.js the page uses, bundled by `make three`.
const THREE: &str = include_str!("../../../../web/view/three.js");
const THREE_LICENSE: &str = include_str!("../../../../web/view/three.LICENSE");

/// The page, with as much inside it as has been held.
pub(super) fn html(name: &str, table: &Table, chunks: &Chunks) -> Result<String> {
    let mut page = String::new();
    // Each mark once, in their order, so that nothing that is filled in is taken for one.
    let mut rest = HTML;
    let mut fill = |mark: &str, content: &str| {
        let (before, after) = rest.split_once(mark).unwrap_or((rest, ""));
        page += before;
        page += content;
        rest = after;
    };
    let name = escape(name);
    fill("@NAME@", &name);
    fill("@CSS@", &format!("{LOOK}{CSS}"));
    fill("@NAME@", &name);
    // What ends a script inside a text would end it there too.
    fill("@RUN@", &serde_json::to_string(table)?.replace("</", "<\\/"));
    fill("@CHUNKS@", &held(chunks));
    fill("@THREE@", &format!("/*! three.js\n{THREE_LICENSE}*/\n{THREE}"));
    fill("@VIEW@", &format!("{SHAPES}{WORLD}{VIEW}"));
    Ok(page + rest)
}

fn held(chunks: &Chunks) -> String {
    let mut scripts = String::new();
    for (name, content) in chunks.held() {
        let _ = writeln!(scripts, "<script type=\"application/json\" id=\"{}\">{content}</script>", escape(name));
    }
    scripts
}
