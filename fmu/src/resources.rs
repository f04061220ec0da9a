//! Location of the FMU's resources. FMI 2.0 passes a URI and FMI 3.0 a path; hosts write both in many forms.
//!
//! Source: RFC 8089 (file URIs) with its appendix E on common deviations; FMI 2.0.4 section 2.1.5, FMI 3.0.2 section 2.3.1.

use std::io::Read;
use std::path::PathBuf;

use moorline::output::package::SCENE_FILE;
use moorline::scene::input_file;

/// Reads the text of the FMU's scene.
///
/// # Errors
/// The location is missing or unusable, or the scene cannot be read there; the message includes the path.
pub(crate) fn read_scene(location: Option<&[u8]>) -> Result<String, String> {
    let location = location
        .filter(|location| !location.is_empty())
        .ok_or("the host gave no resource location, and the scene is in the resources")?;
    let files: Vec<PathBuf> = candidates(location, cfg!(windows))?
        .into_iter()
        .map(|folder| Ok(path_of(folder)?.join(SCENE_FILE)))
        .collect::<Result<_, String>>()?;
    let file = files.iter().find(|file| file.is_file()).unwrap_or(&files[0]);
    let said = format!(" (resource location \"{}\")", String::from_utf8_lossy(location));
    let mut text = String::new();
    input_file::open(file, "a scene file", input_file::SIZE_MAX)
        .map_err(|unopened| unopened.at(file, "") + &said)?
        .read_to_string(&mut text)
        .map_err(|e| format!("{}: {e}{said}", file.display()))?;
    Ok(text)
}

/// Converts bytes to a path, which on Unix need not be UTF-8.
#[cfg(unix)]
fn path_of(bytes: Vec<u8>) -> Result<PathBuf, String> {
    use std::os::unix::ffi::OsStringExt;
    Ok(std::ffi::OsString::from_vec(bytes).into())
}

/// Converts bytes to a path.
#[cfg(not(unix))]
fn path_of(bytes: Vec<u8>) -> Result<PathBuf, String> {
    let text = String::from_utf8(bytes)
        .map_err(|error| format!("the resource location is not UTF-8 text: {error}"))?;
    Ok(text.into())
}

/// Returns the scheme of a URI with `//` after the colon; a drive letter is not a scheme.
fn scheme(location: &[u8]) -> Option<&str> {
    let end = location.windows(3).position(|three| three == b"://")?;
    let scheme = std::str::from_utf8(&location[..end]).ok()?;
    let letters = |c: char| c.is_ascii_alphanumeric() || "+-.".contains(c);
    let begins = scheme.starts_with(|c: char| c.is_ascii_alphabetic());
    (end > 1 && begins && scheme.chars().all(letters)).then_some(scheme)
}

/// Folders that a resource location may refer to, the most likely first; never empty.
fn candidates(location: &[u8], windows: bool) -> Result<Vec<Vec<u8>>, String> {
    let is_file = location
        .get(..5)
        .is_some_and(|scheme| scheme.eq_ignore_ascii_case(b"file:"));
    if !is_file {
        return match scheme(location) {
            Some(scheme) => Err(format!(
                "the resource location \"{}\" is a URI of scheme \"{scheme}\": file:///path or a path would be right",
                String::from_utf8_lossy(location)
            )),
            None => Ok(vec![location.to_vec()]),
        };
    }
    let raw = path_of_uri(&location[5..], windows)?;
    // A host that does not escape characters may pass a folder name with a per cent sign.
    let mut folders = vec![raw.clone()];
    let decoded = percent_decoded(&raw);
    if decoded != raw {
        folders.insert(0, decoded);
    }
    Ok(folders)
}

/// Returns the path in the part of a URI after `file:`, still escaped.
fn path_of_uri(rest: &[u8], windows: bool) -> Result<Vec<u8>, String> {
    let path = match rest.strip_prefix(b"//") {
        None => rest,                         // file:/p, or file:p
        Some(rest) if is_drive(rest) => rest, // file://C:/p, with one slash missing
        Some(rest) => {
            let end = rest.iter().position(|byte| *byte == b'/');
            let (host, path) = rest.split_at(end.unwrap_or(rest.len()));
            if host.is_empty() || host.eq_ignore_ascii_case(b"localhost") {
                path
            } else if windows {
                return Ok([b"//", host, path].concat()); // a network share
            } else {
                return Err(format!(
                    "the resource location names the host \"{}\": file:///path or a path would be right",
                    String::from_utf8_lossy(host)
                ));
            }
        }
    };
    let slashes = path.iter().take_while(|byte| **byte == b'/').count();
    let single = &path[slashes..];
    if is_drive(single) && windows {
        return Ok(single.to_vec());
    }
    if !windows && slashes > 1 {
        return Ok([b"/", single].concat()); // file:////p
    }
    Ok(path.to_vec())
}

/// Returns whether a path begins with a drive letter.
fn is_drive(path: &[u8]) -> bool {
    matches!(path, [letter, b':' | b'|', ..] if letter.is_ascii_alphabetic())
}

/// Decodes %XX. A per cent sign without two hexadecimal digits is kept.
fn percent_decoded(text: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text;
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
    bytes
}

fn hex(digit: u8) -> Option<u8> {
    char::from(digit).to_digit(16).and_then(|d| u8::try_from(d).ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn first(location: &str, windows: bool) -> String {
        let folder = candidates(location.as_bytes(), windows).unwrap().remove(0);
        String::from_utf8(folder).unwrap()
    }

    #[test]
    fn every_form_of_a_location_that_hosts_use_is_understood() {
        for (location, path) in [
            ("file:///data/a/resources", "/data/a/resources"),
            ("file:/data/a/resources", "/data/a/resources"),
            ("file://localhost/data/a", "/data/a"),
            ("FILE:////data/a", "/data/a"),
            ("file:///data/sp%20dir%20%C3%B8%20%7Bx%7D", "/data/sp dir ø {x}"),
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
            candidates(b"file:///data/50%25", false).unwrap(),
            [b"/data/50%".to_vec(), b"/data/50%25".to_vec()]
        );
    }

    #[test]
    fn another_host_and_a_missing_location_are_refused_in_words() {
        let message = read_scene(Some(b"file://elsewhere/a")).unwrap_err();
        assert!(message.contains("elsewhere"), "{message}");
        assert!(read_scene(None).unwrap_err().contains("no resource location"));
        let message = read_scene(Some(b"/does/not/exist")).unwrap_err();
        assert!(message.contains("/does/not/exist"), "{message}");
    }

    #[test]
    fn a_uri_of_another_scheme_is_refused_by_its_name() {
        for location in ["http://a.b/resources", "FTP://a", "s3+x://bucket/a"] {
            let message = read_scene(Some(location.as_bytes())).unwrap_err();
            let scheme = location.split(':').next().unwrap();
            let wanted = format!("is a URI of scheme \"{scheme}\"");
            assert!(message.contains(&wanted), "{message}");
        }
        // a folder may have such a name
        assert_eq!(first("./http:/a", false), "./http:/a");
    }

    #[cfg(unix)]
    #[test]
    fn a_path_that_is_not_utf_8_is_read() {
        use std::os::unix::ffi::OsStrExt;
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join(std::ffi::OsStr::from_bytes(b"odd \xff"));
        std::fs::create_dir(&place).unwrap();
        std::fs::write(place.join(SCENE_FILE), "title = \"\"").unwrap();
        let path = place.as_os_str().as_bytes();
        let escaped = [b"file://", folder.path().as_os_str().as_bytes(), b"/odd%20%FF"].concat();
        for location in [path, &[b"file://", path].concat(), &escaped] {
            assert_eq!(read_scene(Some(location)).unwrap(), "title = \"\"");
        }
    }
}
