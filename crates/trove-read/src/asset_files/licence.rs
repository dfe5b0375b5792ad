//! Licences by the texts that lie beside models.

use trove_files::Folder;

use super::scan::folder_of;

/// What a licence file says.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Terms {
    /// SPDX name, or the file's where its text is not known.
    pub(super) licence: String,
    pub(super) author: Option<String>,
    /// The file.
    pub(super) file: String,
}

/// Phrases that a licence has and the ones above it have not, in small letters.
const KNOWN: [(&str, &str); 17] = [
    ("attribution-noncommercial-sharealike 4.0", "CC-BY-NC-SA-4.0"),
    ("attribution-noncommercial 4.0", "CC-BY-NC-4.0"),
    ("attribution-sharealike 4.0", "CC-BY-SA-4.0"),
    ("attribution-sharealike 3.0", "CC-BY-SA-3.0"),
    ("attribution 4.0", "CC-BY-4.0"),
    ("attribution 3.0", "CC-BY-3.0"),
    ("licenses/by-nc-sa/4.0", "CC-BY-NC-SA-4.0"),
    ("licenses/by-nc/4.0", "CC-BY-NC-4.0"),
    ("licenses/by-sa/4.0", "CC-BY-SA-4.0"),
    ("licenses/by/4.0", "CC-BY-4.0"),
    ("licenses/by/3.0", "CC-BY-3.0"),
    ("cc0", "CC0-1.0"),
    ("publicdomain/zero", "CC0-1.0"),
    ("apache license", "Apache-2.0"),
    ("permission is hereby granted, free of charge", "MIT"),
    ("redistribution and use in source and binary forms", "BSD-3-Clause"),
    ("unlicense", "Unlicense"),
];

/// The SPDX name of a licence by its text or its usual names.
pub(super) fn spdx(text: &str) -> Option<&'static str> {
    let text = text.to_lowercase();
    let short = || {
        let name = text.trim().replace([' ', '_'], "-");
        KNOWN.iter().map(|k| k.1).find(|spdx| name.starts_with(&spdx.to_lowercase()))
    };
    KNOWN.iter().find(|(phrase, _)| text.contains(phrase)).map(|k| k.1).or_else(short)
}

/// The terms of each licence file, with its folder. A README counts where its text names a known licence.
pub(super) fn terms(folder: &Folder, files: &[String]) -> Vec<(String, Terms)> {
    let read = |file: &String| {
        let bytes = folder.read(folder.path(), file).ok()?;
        let text = String::from_utf8_lossy(&bytes[..bytes.len().min(20_000)]).into_owned();
        let known = spdx(&text).map(str::to_owned);
        let readme = file.to_lowercase().contains("readme");
        let licence =
            if readme { known? } else { known.unwrap_or_else(|| format!("LicenseRef-{}", file.replace('/', "-"))) };
        Some((folder_of(file).to_owned(), Terms { licence, author: author(&text), file: file.clone() }))
    };
    files.iter().filter_map(read).collect()
}

/// The terms that hold for a file: those in its folder or the nearest one around it.
pub(super) fn nearest<'a>(all: &'a [(String, Terms)], file: &str) -> Option<&'a Terms> {
    let folder = folder_of(file);
    let around =
        |f: &str| f.is_empty() || folder == f || folder.strip_prefix(f).is_some_and(|rest| rest.starts_with('/'));
    all.iter().filter(|(f, _)| around(f)).max_by_key(|(f, _)| f.len()).map(|(_, terms)| terms)
}

/// The name behind `Copyright (c) 2012` or after `by @`.
fn author(text: &str) -> Option<String> {
    let line = text.lines().find(|l| l.to_lowercase().contains("copyright") && l.chars().any(|c| c.is_ascii_digit()));
    if let Some(line) = line {
        let noise = |c: char| !c.is_alphabetic();
        let after = line.rsplit(|c: char| c.is_ascii_digit()).next().unwrap_or_default();
        let name = after.trim_matches(noise).trim_start_matches("by ").trim();
        return (!name.is_empty()).then(|| name.to_owned());
    }
    let by = text.split_once(" by @")?.1;
    let name: String = by.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
    (!name.is_empty()).then_some(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn licences_are_known_by_their_texts() {
        for (text, spdx_name) in [
            ("CC0 1.0 Universal (CC0 1.0)\nPublic Domain Dedication", "CC0-1.0"),
            ("Creative Commons Attribution 3.0 Unported License", "CC-BY-3.0"),
            ("CC-BY-4.0 (http://creativecommons.org/licenses/by/4.0/)", "CC-BY-4.0"),
            ("Attribution-NonCommercial 4.0 International", "CC-BY-NC-4.0"),
            ("mit", "MIT"),
        ] {
            assert_eq!(spdx(text), Some(spdx_name), "{text}");
        }
        assert_eq!(spdx("All rights reserved."), None);
        assert_eq!(
            author("Copyright (c) 2012-2021 Scott Chacon and others\n").as_deref(),
            Some("Scott Chacon and others")
        );
        assert_eq!(author("LowPoly Models by @Quaternius\n").as_deref(), Some("Quaternius"));
    }

    #[test]
    fn the_nearest_licence_holds() {
        let terms = |name: &str| Terms { licence: name.into(), author: None, file: name.into() };
        let all = [(String::new(), terms("a")), ("cars".into(), terms("b"))];
        let of = |file: &str| nearest(&all, file).map(|t| t.licence.as_str());
        assert_eq!(
            [of("x.glb"), of("cars/x.glb"), of("cars/old/x.glb"), of("carsx/x.glb")],
            [Some("a"), Some("b"), Some("b"), Some("a")]
        );
    }
}
