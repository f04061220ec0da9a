//! Where the FMU's resources are: FMI 2.0 gives a URI, FMI 3.0 a path, and hosts give both in many forms.
//!
//! Source: RFC 8089 (file URIs) with its appendix E on common deviations; FMI 2.0.4 section 2.1.5, FMI 3.0.2 section 2.3.1.

use std::path::PathBuf;

use moorline::output::package::SCENE_FILE;

/// The text of the FMU's scene.
///
/// # Errors
/// Where it was looked for.
pub(crate) fn read_scene(location: Option<&str>) -> Result<String, String> {
    let location = location
        .filter(|location| !location.is_empty())
        .ok_or("the host gave no resource location, and the scene is in the resources")?;
    let files: Vec<PathBuf> = candidates(location, cfg!(windows))?
        .into_iter()
        .map(|folder| PathBuf::from(folder).join(SCENE_FILE))
        .collect();
    let file = files
        .iter()
        .find(|file| file.is_file())
        .unwrap_or(&files[0]);
    std::fs::read_to_string(file)
        .map_err(|e| format!("{}: {e} (resource location \"{location}\")", file.display()))
}

/// Folders that a resource location may mean, the likeliest first; never empty.
fn candidates(location: &str, windows: bool) -> Result<Vec<String>, String> {
    let Some(scheme) = location.get(..5) else {
        return Ok(vec![location.to_string()]);
    };
    if !scheme.eq_ignore_ascii_case("file:") {
        return Ok(vec![location.to_string()]);
    }
    let raw = path_of_uri(&location[5..], windows)?;
    // A host that does not escape may name a folder that holds a per cent sign.
    let mut folders = vec![raw.clone()];
    if let Some(decoded) = percent_decoded(&raw)
        && decoded != raw
    {
        folders.insert(0, decoded);
    }
    Ok(folders)
}

/// The path in what follows `file:`, still escaped.
fn path_of_uri(rest: &str, windows: bool) -> Result<String, String> {
    let path = match rest.strip_prefix("//") {
        None => rest.to_string(),                         // file:/p, or file:p
        Some(rest) if is_drive(rest) => rest.to_string(), // file://C:/p, one slash short
        Some(rest) => {
            let (host, path) = rest.split_at(rest.find('/').unwrap_or(rest.len()));
            if host.is_empty() || host.eq_ignore_ascii_case("localhost") {
                path.to_string()
            } else if windows {
                format!("//{host}{path}") // a share
            } else {
                return Err(format!(
                    "the resource location names the host \"{host}\": file:///path or a path would be right"
                ));
            }
        }
    };
    let single = path.trim_start_matches('/');
    if is_drive(single) && windows {
        return Ok(single.to_string());
    }
    if !windows && path.starts_with("//") {
        return Ok(format!("/{single}")); // file:////p
    }
    Ok(path)
}

/// Whether a path begins with a drive letter.
fn is_drive(path: &str) -> bool {
    let mut characters = path.chars();
    characters.next().is_some_and(|c| c.is_ascii_alphabetic())
        && matches!(characters.next(), Some(':' | '|'))
}

/// Replaces %XX; `None` if the result is not UTF-8. A per cent sign without two digits stays.
fn percent_decoded(text: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let [first, tail @ ..] = rest {
        let digits = tail
            .get(..2)
            .and_then(|pair| Some((hex(pair[0])?, hex(pair[1])?)));
        match (first, digits) {
            (b'%', Some((high, low))) => {
                bytes.push(16 * high + low);
                rest = &tail[2..];
            }
            _ => {
                bytes.push(*first);
                rest = tail;
            }
        }
    }
    String::from_utf8(bytes).ok()
}

fn hex(digit: u8) -> Option<u8> {
    char::from(digit)
        .to_digit(16)
        .and_then(|d| u8::try_from(d).ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn first(location: &str, windows: bool) -> String {
        candidates(location, windows).unwrap().remove(0)
    }

    #[test]
    fn every_form_of_a_location_that_hosts_use_is_understood() {
        for (location, path) in [
            ("file:///data/a/resources", "/data/a/resources"),
            ("file:/data/a/resources", "/data/a/resources"),
            ("file://localhost/data/a", "/data/a"),
            ("FILE:////data/a", "/data/a"),
            (
                "file:///data/sp%20dir%20%C3%B8%20%7Bx%7D",
                "/data/sp dir ø {x}",
            ),
            ("file:///data/sp dir ø {x}", "/data/sp dir ø {x}"),
            ("file:///data/100%/a", "/data/100%/a"),
            ("/data/a/resources/", "/data/a/resources/"),
            ("/data/a%20b", "/data/a%20b"),
            ("res", "res"),
        ] {
            assert_eq!(first(location, false), path, "{location}");
        }
    }

    #[test]
    fn drive_letters_and_shares_are_understood_on_windows() {
        for (location, path) in [
            ("file:///C:/a%20b/resources", "C:/a b/resources"),
            ("file:/C:/a", "C:/a"),
            ("file://C:/a", "C:/a"),
            ("file://server/share/a", "//server/share/a"),
            ("C:\\a\\resources\\", "C:\\a\\resources\\"),
        ] {
            assert_eq!(first(location, true), path, "{location}");
        }
    }

    #[test]
    fn a_folder_with_an_unescaped_per_cent_sign_is_the_second_choice() {
        assert_eq!(
            candidates("file:///data/50%25", false).unwrap(),
            ["/data/50%", "/data/50%25"]
        );
    }

    #[test]
    fn another_host_and_a_missing_location_are_refused_in_words() {
        let message = read_scene(Some("file://elsewhere/a")).unwrap_err();
        assert!(message.contains("elsewhere"), "{message}");
        assert!(
            read_scene(None)
                .unwrap_err()
                .contains("no resource location")
        );
        let message = read_scene(Some("/does/not/exist")).unwrap_err();
        assert!(message.contains("/does/not/exist"), "{message}");
    }
}
