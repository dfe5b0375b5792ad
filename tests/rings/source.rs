//! What the source of a crate says of its modules: what they define, what they bring in, and what they name.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::read_to_string;
use std::path::{Path, PathBuf};

/// Who names what of whom: (file, file that defines it) → the names.
pub(crate) type Arrows = BTreeMap<(PathBuf, PathBuf), BTreeSet<String>>;

/// A module, a file's or one written inside a file.
#[derive(Default)]
pub(crate) struct Module {
    pub file: PathBuf,
    children: BTreeSet<String>,
    /// Functions, types, constants and macros that it defines.
    items: BTreeSet<String>,
    /// What `use` brings in, by the name it has here; `*` for what is brought in whole.
    uses: Vec<(String, Vec<String>)>,
    /// Names that `pub use` alone asks for.
    exported: BTreeSet<String>,
    /// Paths in its code, of one name or more.
    paths: BTreeSet<Vec<String>>,
}

/// Names are followed through at most as many re-exports and folders; what is longer leads out of the crate.
const MOST_STEPS: usize = 24;

#[derive(Default)]
pub(crate) struct Crate {
    pub modules: BTreeMap<Vec<String>, Module>,
}

/// Names and marks of Rust source, without comments, strings, characters and lifetimes.
fn tokens(text: &str) -> Vec<String> {
    let chars: Vec<char> = text.chars().collect();
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    let at = |i: usize| chars.get(i).copied().unwrap_or('\0');
    let mut found = Vec::new();
    let mut i = 0;
    while i < chars.len() {
        match chars[i] {
            '/' if at(i + 1) == '/' => i += chars[i..].iter().take_while(|&&c| c != '\n').count(),
            '/' if at(i + 1) == '*' => {
                let mut depth = 0;
                loop {
                    let step = (at(i), at(i + 1));
                    depth += i32::from(step == ('/', '*')) - i32::from(step == ('*', '/'));
                    i += if step == ('/', '*') || step == ('*', '/') { 2 } else { 1 };
                    if depth == 0 || i >= chars.len() {
                        break;
                    }
                }
            }
            '"' => {
                i += 1;
                while i < chars.len() && chars[i] != '"' {
                    i += if chars[i] == '\\' { 2 } else { 1 };
                }
                i += 1;
            }
            '\'' if at(i + 1) == '\\' || at(i + 2) == '\'' => {
                i += 2;
                i += chars[i.min(chars.len())..].iter().take_while(|&&c| c != '\'').count() + 1;
            }
            '\'' => i += 1 + chars[i + 1..].iter().take_while(|&&c| is_name(c)).count(),
            c if is_name(c) => {
                let name: String = chars[i..].iter().take_while(|&&c| is_name(c)).collect();
                i += name.chars().count();
                let hashes = chars[i..].iter().take_while(|&&c| c == '#').count();
                if name.ends_with('r') && name.len() <= 2 && at(i + hashes) == '"' {
                    let end: Vec<char> = std::iter::once('"').chain(std::iter::repeat_n('#', hashes)).collect();
                    i += hashes + 1;
                    i += chars[i..].windows(end.len()).position(|w| w == end).unwrap() + end.len();
                } else {
                    found.push(name);
                }
            }
            ':' if at(i + 1) == ':' => {
                found.push("::".into());
                i += 2;
            }
            c => {
                if !c.is_whitespace() {
                    found.push(c.into());
                }
                i += 1;
            }
        }
    }
    found
}

/// How many tokens the item takes that stands at the front: up to its `;` or its closing brace.
fn item_length(tokens: &[String]) -> usize {
    let mut depth = 0;
    for (i, token) in tokens.iter().enumerate() {
        match token.as_str() {
            "{" | "(" | "[" => depth += 1,
            "}" | ")" | "]" => depth -= 1,
            _ => {}
        }
        if depth == 0 && (token == ";" || token == "}") {
            return i + 1;
        }
    }
    tokens.len()
}

/// The names and paths of a `use` tree, such as `a::{b, c as d}`.
fn use_tree(tokens: &[String], prefix: &[String], found: &mut Vec<(String, Vec<String>)>) {
    let mut path = prefix.to_vec();
    let mut i = 0;
    while i < tokens.len() {
        match tokens[i].as_str() {
            "::" => {}
            "{" => {
                let (mut depth, mut start) = (0, i + 1);
                for j in i..tokens.len() {
                    depth += i32::from(tokens[j] == "{") - i32::from(tokens[j] == "}");
                    if (depth == 1 && tokens[j] == ",") || depth == 0 {
                        if j > start {
                            use_tree(&tokens[start..j], &path, found);
                        }
                        start = j + 1;
                    }
                    if depth == 0 {
                        break;
                    }
                }
                return;
            }
            "as" => return found.push((tokens[i + 1].clone(), path)),
            "self" if !path.is_empty() => {}
            name => path.push(name.into()),
        }
        i += 1;
    }
    found.push((path.last().unwrap().clone(), path));
}

impl Crate {
    pub(crate) fn read(root: &Path) -> Self {
        let mut all = Self::default();
        all.file(root, root.parent().unwrap(), Vec::new());
        all
    }

    /// Reads a file as a module whose children lie in a folder.
    fn file(&mut self, file: &Path, folder: &Path, name: Vec<String>) {
        self.modules.insert(name.clone(), Module { file: file.into(), ..Module::default() });
        self.code(&tokens(&read_to_string(file).unwrap()), &name, folder);
    }

    fn code(&mut self, tokens: &[String], name: &[String], folder: &Path) {
        const ITEMS: [&str; 9] = ["fn", "struct", "enum", "trait", "type", "const", "static", "union", "macro_rules"];
        let child = |at: usize| [name, &[tokens[at].clone()]].concat();
        let (mut i, mut depth, mut public) = (0, 0, false);
        while i < tokens.len() {
            let token = tokens[i].as_str();
            let next = tokens.get(i + 1).map_or("", String::as_str);
            if token == "#" && (next == "[" || next == "!") {
                let end = i + 1 + tokens[i..].iter().position(|t| t == "]").unwrap();
                let is_test = tokens[i..end].contains(&"cfg".into()) && tokens[i..end].contains(&"test".into());
                i = end + if is_test { item_length(&tokens[end..]) } else { 0 };
                continue;
            }
            let module = self.modules.get_mut(name).unwrap();
            match token {
                "use" => {
                    let end = i + tokens[i..].iter().position(|t| t == ";").unwrap();
                    let mut found = Vec::new();
                    use_tree(&tokens[i + 1..end], &[], &mut found);
                    if public {
                        module.exported.extend(found.iter().map(|f| f.0.clone()));
                    }
                    module.uses.extend(found);
                    i = end;
                    continue;
                }
                "mod" if depth == 0 => {
                    module.children.insert(next.into());
                    let inner = folder.join(next);
                    if tokens[i + 2] == "{" {
                        let end = i + item_length(&tokens[i..]);
                        let file = module.file.clone();
                        self.modules.insert(child(i + 1), Module { file, ..Module::default() });
                        self.code(&tokens[i + 3..end - 1], &child(i + 1), &inner);
                        i = end;
                    } else {
                        let files = [inner.with_extension("rs"), inner.join("mod.rs")];
                        let file = files.iter().find(|f| f.exists()).expect("a declared module has a file");
                        self.file(file, &inner, child(i + 1));
                        i += 3;
                    }
                    continue;
                }
                "{" => depth += 1,
                "}" => depth -= 1,
                _ if depth == 0 && ITEMS.contains(&token) => {
                    let at = i + 1 + usize::from(next == "!");
                    module.items.insert(tokens[at].clone());
                }
                _ if token.starts_with(|c: char| c.is_alphabetic() || c == '_') => {
                    let mut path = vec![token.to_owned()];
                    while tokens.get(i + 1).is_some_and(|t| t == "::")
                        && tokens.get(i + 2).is_some_and(|t| t.starts_with(|c: char| c.is_alphabetic() || c == '_'))
                    {
                        path.push(tokens[i + 2].clone());
                        i += 2;
                    }
                    module.paths.insert(path);
                }
                _ => {}
            }
            // `pub`, `pub(crate)` and the like stand right before what they make known.
            public = token == "pub" || (public && ["(", ")", "crate", "super", "self", "in"].contains(&token));
            i += 1;
        }
    }

    /// The file that defines what a path names, from within a module; `None` for what is not this crate's.
    fn definition(&self, from: &[String], path: &[String], steps: usize) -> Option<&Path> {
        let module = self.modules.get(from).filter(|_| steps < MOST_STEPS)?;
        let (first, rest) = path.split_first()?;
        match first.as_str() {
            "crate" => self.definition(&[], rest, steps + 1),
            "self" => self.definition(from, rest, steps + 1),
            "super" => self.definition(&from[..from.len().checked_sub(1)?], rest, steps + 1),
            // What stands alone is an item, though a module may have its name.
            name if module.children.contains(name) && !rest.is_empty() => {
                self.definition(&[from, std::slice::from_ref(first)].concat(), rest, steps + 1)
            }
            name if module.items.contains(name) => Some(&module.file),
            name => module.uses.iter().filter(|u| u.0 == name || u.0 == "*").find_map(|(known, target)| {
                if known != "*" {
                    return self.definition(from, &[target, rest].concat(), steps + 1);
                }
                let is_ours = ["crate", "self", "super"].contains(&&*target[0]) || module.children.contains(&target[0]);
                let whole = target[..target.len() - 1].iter().chain(path).cloned().collect::<Vec<_>>();
                if is_ours { self.definition(from, &whole, steps + 1) } else { None }
            }),
        }
    }

    /// Who names what of whom: (file, file that defines it) → the names; paths from a folder on.
    pub(crate) fn arrows(&self, folder: &Path) -> Arrows {
        let mut arrows = Arrows::new();
        for (name, module) in &self.modules {
            let is_named = |n: &String| module.paths.iter().any(|p| &p[0] == n);
            let used = module.uses.iter().filter(|(n, _)| is_named(n) || !module.exported.contains(n));
            for path in used.map(|u| &u.1).chain(&module.paths) {
                if let Some(file) = self.definition(name, path, 0).filter(|&f| f != module.file) {
                    let pair = [&*module.file, file].map(|f| f.strip_prefix(folder).unwrap().to_path_buf());
                    arrows.entry(pair.into()).or_default().insert(path.last().unwrap().clone());
                }
            }
        }
        arrows
    }
}
