//! The server's host key: made at the first start, and readable by its owner alone.

use crate::output_file::OutputFile;
use russh::keys::ssh_key::LineEnding;
use russh::keys::ssh_key::private::{Ed25519Keypair, KeypairData};
use russh::keys::{HashAlg, PrivateKey};
use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::os::unix::fs::PermissionsExt;
use std::path::Path;

/// Reads the private key in a file, or writes a new one if there is no file.
///
/// # Errors
/// If the file can be read by others, or is no private key without a passphrase.
pub(super) fn load_or_make(path: &Path) -> io::Result<PrivateKey> {
    match fs::metadata(path) {
        Ok(found) if found.permissions().mode() & 0o077 != 0 => {
            let mode = found.permissions().mode() & 0o777;
            Err(io::Error::other(format!("others may read this key (mode {mode:03o}); chmod 600 makes it secret")))
        }
        Ok(_) => {
            let text = fs::read_to_string(path)?;
            let wrong = |error| io::Error::other(format!("no private key of OpenSSH: {error}"));
            let key = PrivateKey::from_openssh(&text).map_err(wrong)?;
            if key.is_encrypted() {
                return Err(io::Error::other("a passphrase protects this key; the server needs one without"));
            }
            Ok(key)
        }
        Err(error) if error.kind() == io::ErrorKind::NotFound => make(path),
        Err(error) => Err(error),
    }
}

fn make(path: &Path) -> io::Result<PrivateKey> {
    let mut seed = [0; 32];
    // Reading the device directly avoids a dependency on a crate for random numbers.
    File::open("/dev/urandom")?.read_exact(&mut seed)?;
    let key = PrivateKey::new(KeypairData::Ed25519(Ed25519Keypair::from_seed(&seed)), "termtrace serve");
    let key = key.map_err(io::Error::other)?;
    if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        fs::create_dir_all(folder)?;
    }
    let mut file = OutputFile::create_new_private(path)?;
    file.write_all(key.to_openssh(LineEnding::LF).map_err(io::Error::other)?.as_bytes())?;
    match file.finish() {
        // Another process has meanwhile written a key to this file; that key is read.
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => load_or_make(path),
        done => done.map(|()| key),
    }
}

/// Returns the fingerprint of a key: `SHA256:...`.
pub(super) fn fingerprint(key: &PrivateKey) -> String {
    key.public_key().fingerprint(HashAlg::Sha256).to_string()
}
