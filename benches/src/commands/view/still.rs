//! A picture of the page, drawn by an installed Chromium.

use std::ffi::OsStr;
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use miette::{IntoDiagnostic as _, WrapErr as _, miette};
use sdop::files::Whole;
use tempfile::TempDir;

/// Commands that are Chromium, and where macOS and Windows keep it.
const BROWSERS: [&str; 8] = [
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
    "chrome",
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
    "/Applications/Chromium.app/Contents/MacOS/Chromium",
    "C:\\Program Files\\Google\\Chrome\\Application\\chrome.exe",
];

/// How long a picture may take: a software renderer on a busy machine is slow.
const PATIENCE: Duration = Duration::from_secs(180);

/// Reads a size such as 1280x800.
pub fn size(text: &str) -> Result<(u32, u32), String> {
    let pixels = |text: &str| text.parse::<u32>().ok().filter(|n| (16..=8192).contains(n));
    let (width, height) = text.split_once(['x', '×']).unwrap_or((text, ""));
    pixels(width)
        .zip(pixels(height))
        .ok_or_else(|| "width and height, 16 to 8192 pixels, as in 1280x800".to_owned())
}

/// Whether the path names a PNG.
pub fn is_png(path: &Path) -> bool {
    path.extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("png"))
}

/// The browser: the one asked for, or the first that is installed.
///
/// # Errors
/// There is none.
pub fn browser(asked: Option<&Path>) -> miette::Result<PathBuf> {
    let candidates: Vec<&Path> = match asked {
        Some(path) => vec![path],
        None => BROWSERS.iter().map(Path::new).collect(),
    };
    let found = candidates.into_iter().find_map(installed);
    found.ok_or_else(|| {
        let hint = "install Chromium (Debian: apt-get install chromium) or name it with --browser FILE; the page needs none of this";
        match asked {
            Some(path) => miette!(help = hint, "--png: no browser at {}", path.display()),
            None => miette!(help = hint, "--png draws with Chromium, and there is none on this machine"),
        }
    })
}

/// The file of a command: as named, or in the directories of PATH.
fn installed(command: &Path) -> Option<PathBuf> {
    if command.components().count() > 1 {
        return command.is_file().then(|| command.to_owned());
    }
    let paths = std::env::var_os("PATH")?;
    std::env::split_paths(&paths)
        .map(|directory| directory.join(command))
        .find(|file| file.is_file())
}

/// The part of the page's address behind #.
pub fn address(frame: u32, with: Option<&str>) -> String {
    let with = with.map_or(String::new(), |with| {
        format!("&{}", with.trim_start_matches(['#', '&']))
    });
    format!("frame={frame}{with}&still")
}

/// Draws the page at this address.
///
/// # Errors
/// The browser fails, or takes too long.
pub fn draw(
    browser: &Path,
    page: &Path,
    address: &str,
    (width, height): (u32, u32),
    picture: &Path,
) -> miette::Result<()> {
    let scratch = scratch()?;
    let drawn = scratch.path().join("picture.png");
    let page = std::path::absolute(page).into_diagnostic()?;
    let mut command = Command::new(browser);
    command
        .args([
            "--headless=new",
            "--no-first-run",
            "--hide-scrollbars",
            "--disable-extensions",
            "--mute-audio",
        ])
        // Without a graphics card Chromium must be allowed to draw in software.
        .args([
            "--use-angle=swiftshader",
            "--enable-unsafe-swiftshader",
            "--force-device-scale-factor=1",
        ])
        .arg(option("--user-data-dir=", scratch.path().join("profile")))
        .arg(option("--screenshot=", &drawn))
        .arg(format!("--window-size={width},{height}"))
        .arg(format!("{}#{address}", url(&page)))
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    if is_root(scratch.path()) {
        command.arg("--no-sandbox"); // its sandbox refuses root, as in a container
    }
    let mut child = command
        .spawn()
        .into_diagnostic()
        .wrap_err_with(|| format!("--png: cannot start {}", browser.display()))?;
    wait(&mut child).wrap_err_with(|| format!("--png: {}", browser.display()))?;
    if !drawn.is_file() {
        return Err(miette!(
            help = "does the page open in it?",
            "--png: {} drew nothing",
            browser.display()
        ));
    }
    // The scratch directory may lie on another disk, where a file can't be renamed from.
    keep(&drawn, picture)
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot write {}", picture.display()))
}

fn keep(drawn: &Path, picture: &Path) -> io::Result<()> {
    let mut whole = Whole::create(picture)?;
    io::copy(&mut File::open(drawn)?, &mut whole)?;
    whole.finish()
}

/// A directory that goes when the value does.
///
/// # Errors
/// The system refuses.
pub fn scratch() -> miette::Result<TempDir> {
    TempDir::with_prefix("sdop-view-")
        .into_diagnostic()
        .wrap_err("--png: cannot make a directory for the browser")
}

fn wait(child: &mut Child) -> miette::Result<()> {
    let start = Instant::now();
    loop {
        if child.try_wait().into_diagnostic()?.is_some() {
            return Ok(());
        }
        if start.elapsed() > PATIENCE {
            // It may just have ended by itself.
            let _ = child.kill();
            let _ = child.wait();
            return Err(miette!(
                help = "show fewer bodies",
                "no picture after {} s",
                PATIENCE.as_secs()
            ));
        }
        std::thread::sleep(Duration::from_millis(50));
    }
}

fn option(name: &str, path: impl AsRef<OsStr>) -> std::ffi::OsString {
    let mut option = std::ffi::OsString::from(name);
    option.push(path);
    option
}

/// The file's address: bytes other than plain ones are escaped.
fn url(path: &Path) -> String {
    let text = path.to_string_lossy().replace('\\', "/");
    let mut url = String::from(if text.starts_with('/') {
        "file://"
    } else {
        "file:///"
    });
    for byte in text.bytes() {
        if byte.is_ascii_alphanumeric() || b"/-_.~:".contains(&byte) {
            url.push(char::from(byte));
        } else {
            url.push_str(&format!("%{byte:02X}"));
        }
    }
    url
}

/// Whether this program runs as root: who owns what it has just made.
#[cfg(unix)]
fn is_root(made: &Path) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    std::fs::metadata(made).is_ok_and(|found| found.uid() == 0)
}

#[cfg(not(unix))]
fn is_root(_made: &Path) -> bool {
    false
}
