
using namespace System.Management.Automation
using namespace System.Management.Automation.Language

Register-ArgumentCompleter -Native -CommandName 'termtrace' -ScriptBlock {
    param($wordToComplete, $commandAst, $cursorPosition)

    $commandElements = $commandAst.CommandElements
    $command = @(
        'termtrace'
        for ($i = 1; $i -lt $commandElements.Count; $i++) {
            $element = $commandElements[$i]
            if ($element -isnot [StringConstantExpressionAst] -or
                $element.StringConstantType -ne [StringConstantType]::BareWord -or
                $element.Value.StartsWith('-') -or
                $element.Value -eq $wordToComplete) {
                break
        }
        $element.Value
    }) -join ';'

    $completions = @(switch ($command) {
        'termtrace' {
            [CompletionResult]::new('--eye', '--eye', [CompletionResultType]::ParameterName, 'Where to look from, instead of the scene''s eye point')
            [CompletionResult]::new('--target', '--target', [CompletionResultType]::ParameterName, 'Where to look to, instead of the scene''s target')
            [CompletionResult]::new('--up', '--up', [CompletionResultType]::ParameterName, 'What is vertical in the picture, instead of the scene''s up')
            [CompletionResult]::new('--fov', '--fov', [CompletionResultType]::ParameterName, 'The vertical field of view in degrees, instead of the scene''s')
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'How many threads trace [default: as many as there are cores]')
            [CompletionResult]::new('--color', '--color', [CompletionResultType]::ParameterName, 'Which colours the picture may have [default: auto]')
            [CompletionResult]::new('--glyphs', '--glyphs', [CompletionResultType]::ParameterName, 'What its cells are made of [default: auto]')
            [CompletionResult]::new('--cell-aspect', '--cell-aspect', [CompletionResultType]::ParameterName, 'A cell''s height over its width [default: as the terminal says, or 2]')
            [CompletionResult]::new('--map', '--map', [CompletionResultType]::ParameterName, 'The shaded picture, or a map of the scene [default: shaded]')
            [CompletionResult]::new('--samples', '--samples', [CompletionResultType]::ParameterName, 'Rays per pixel, also in motion, or `best`: 1, and up to 64 where there are edges [default: as many as the time allows, at rest best]')
            [CompletionResult]::new('--quality', '--quality', [CompletionResultType]::ParameterName, 'How near a moving picture is to the right one; it decides bytes, not rays [default: exact; live, on a slow link, equal]')
            [CompletionResult]::new('--max-rate', '--max-rate', [CompletionResultType]::ParameterName, 'The most bytes per second in the mean, such as 50k or 2M; what is most wrong is sent first [default: as many as the link takes]')
            [CompletionResult]::new('--fps', '--fps', [CompletionResultType]::ParameterName, 'The most frames per second [default: 60]')
            [CompletionResult]::new('--move-speed', '--move-speed', [CompletionResultType]::ParameterName, 'How fast keys move the eye: a factor from 0.1 to 10 [default: 1]')
            [CompletionResult]::new('--turn-speed', '--turn-speed', [CompletionResultType]::ParameterName, 'How fast keys turn the view: a factor from 0.1 to 10 [default: 1]')
            [CompletionResult]::new('--reduced-motion', '--reduced-motion', [CompletionResultType]::ParameterName, 'Each press of a key moves one step at once; nothing glides or moves by itself [default: false]')
            [CompletionResult]::new('--order', '--order', [CompletionResultType]::ParameterName, 'In which order changed cells are sent [default: color; live, raster until the link is found slow]')
            [CompletionResult]::new('--compressed-link', '--compressed-link', [CompletionResultType]::ParameterName, 'The link compresses, as ssh -C does: --order raster')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Do not print the camera on leaving')
            [CompletionResult]::new('--no-config', '--no-config', [CompletionResultType]::ParameterName, 'Read none of the user''s own files')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help')
            [CompletionResult]::new('-V', '-V ', [CompletionResultType]::ParameterName, 'Print version')
            [CompletionResult]::new('--version', '--version', [CompletionResultType]::ParameterName, 'Print version')
            [CompletionResult]::new('frame', 'frame', [CompletionResultType]::ParameterValue, 'Print one frame, or compare it with a golden one')
            [CompletionResult]::new('record', 'record', [CompletionResultType]::ParameterValue, 'Record a film along a camera path: asciicast, GIF or numbered PNGs')
            [CompletionResult]::new('explain', 'explain', [CompletionResultType]::ParameterValue, 'Say what a pixel comes from: its ray, what that met, the lights')
            [CompletionResult]::new('check', 'check', [CompletionResultType]::ParameterValue, 'Say what is wrong with a scene file, or that it is fine')
            [CompletionResult]::new('describe', 'describe', [CompletionResultType]::ParameterValue, 'Say in words what a picture shows')
            [CompletionResult]::new('bench', 'bench', [CompletionResultType]::ParameterValue, 'Time the tracing of a scene')
            [CompletionResult]::new('doctor', 'doctor', [CompletionResultType]::ParameterValue, 'Say what this terminal can do and who says so, and draw a test card')
            [CompletionResult]::new('config', 'config', [CompletionResultType]::ParameterValue, 'Say which settings hold, and who says so')
            [CompletionResult]::new('completions', 'completions', [CompletionResultType]::ParameterValue, 'Print what a shell is to know to complete arguments')
            [CompletionResult]::new('man', 'man', [CompletionResultType]::ParameterValue, 'Print the manual, for man')
            break
        }
        'termtrace;frame' {
            [CompletionResult]::new('--eye', '--eye', [CompletionResultType]::ParameterName, 'Where to look from, instead of the scene''s eye point')
            [CompletionResult]::new('--target', '--target', [CompletionResultType]::ParameterName, 'Where to look to, instead of the scene''s target')
            [CompletionResult]::new('--up', '--up', [CompletionResultType]::ParameterName, 'What is vertical in the picture, instead of the scene''s up')
            [CompletionResult]::new('--fov', '--fov', [CompletionResultType]::ParameterName, 'The vertical field of view in degrees, instead of the scene''s')
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'How many threads trace [default: as many as there are cores]')
            [CompletionResult]::new('--size', '--size', [CompletionResultType]::ParameterName, 'The frame''s size in cells [default: 80x24]')
            [CompletionResult]::new('--pixels', '--pixels', [CompletionResultType]::ParameterName, 'The frame''s size in pixels; a cell has two of them, one above the other, or with --glyphs shape two by four')
            [CompletionResult]::new('--cell-aspect', '--cell-aspect', [CompletionResultType]::ParameterName, 'A cell''s height over its width')
            [CompletionResult]::new('--samples', '--samples', [CompletionResultType]::ParameterName, 'Rays per pixel, the first through its centre; or `best`: 1, and up to 64 where there are edges')
            [CompletionResult]::new('--scale', '--scale', [CompletionResultType]::ParameterName, 'Picture files: make each pixel N by N of the file''s [default: 1]')
            [CompletionResult]::new('--map', '--map', [CompletionResultType]::ParameterName, 'The shaded picture, or a map of the scene [default: shaded]')
            [CompletionResult]::new('--color', '--color', [CompletionResultType]::ParameterName, 'Which colours the picture may have [default: auto]')
            [CompletionResult]::new('--glyphs', '--glyphs', [CompletionResultType]::ParameterName, 'What its cells are made of [default: auto]')
            [CompletionResult]::new('--format', '--format', [CompletionResultType]::ParameterName, 'What to write [default: as the file name''s ending says, or text]')
            [CompletionResult]::new('-o', '-o', [CompletionResultType]::ParameterName, 'Write to a file; - is standard output [default: -]')
            [CompletionResult]::new('--output', '--output', [CompletionResultType]::ParameterName, 'Write to a file; - is standard output [default: -]')
            [CompletionResult]::new('--check', '--check', [CompletionResultType]::ParameterName, 'Compare with the frame in a file instead of writing one; exit code 1 and a diff if they differ')
            [CompletionResult]::new('--no-config', '--no-config', [CompletionResultType]::ParameterName, 'Read none of the user''s own files')
            [CompletionResult]::new('--bless', '--bless', [CompletionResultType]::ParameterName, 'With --check: write the file')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'termtrace;record' {
            [CompletionResult]::new('--eye', '--eye', [CompletionResultType]::ParameterName, 'Where to look from, instead of the scene''s eye point')
            [CompletionResult]::new('--target', '--target', [CompletionResultType]::ParameterName, 'Where to look to, instead of the scene''s target')
            [CompletionResult]::new('--up', '--up', [CompletionResultType]::ParameterName, 'What is vertical in the picture, instead of the scene''s up')
            [CompletionResult]::new('--fov', '--fov', [CompletionResultType]::ParameterName, 'The vertical field of view in degrees, instead of the scene''s')
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'How many threads trace [default: as many as there are cores]')
            [CompletionResult]::new('--path', '--path', [CompletionResultType]::ParameterName, 'How the camera moves: orbit, or a file of keyframes')
            [CompletionResult]::new('--seconds', '--seconds', [CompletionResultType]::ParameterName, 'How long the film is [default: 8, or as long as the path file]')
            [CompletionResult]::new('--fps', '--fps', [CompletionResultType]::ParameterName, 'Frames per second')
            [CompletionResult]::new('--size', '--size', [CompletionResultType]::ParameterName, 'The frame''s size in cells [default: 80x24]')
            [CompletionResult]::new('--pixels', '--pixels', [CompletionResultType]::ParameterName, 'The frame''s size in pixels; a cell has two of them, one above the other, or with --glyphs shape two by four')
            [CompletionResult]::new('--cell-aspect', '--cell-aspect', [CompletionResultType]::ParameterName, 'A cell''s height over its width')
            [CompletionResult]::new('--samples', '--samples', [CompletionResultType]::ParameterName, 'Rays per pixel, the first through its centre; or `best`: 1, and up to 64 where there are edges')
            [CompletionResult]::new('--scale', '--scale', [CompletionResultType]::ParameterName, 'Picture files: make each pixel N by N of the file''s [default: 1]')
            [CompletionResult]::new('--map', '--map', [CompletionResultType]::ParameterName, 'The shaded picture, or a map of the scene [default: shaded]')
            [CompletionResult]::new('--order', '--order', [CompletionResultType]::ParameterName, 'In which order changed cells are sent [default: color; live, raster until the link is found slow]')
            [CompletionResult]::new('--quality', '--quality', [CompletionResultType]::ParameterName, 'How near a moving picture is to the right one; it decides bytes, not rays [default: exact; live, on a slow link, equal]')
            [CompletionResult]::new('--max-rate', '--max-rate', [CompletionResultType]::ParameterName, 'The most bytes per second in the mean, such as 50k or 2M; what is most wrong is sent first [default: as many as the link takes]')
            [CompletionResult]::new('-o', '-o', [CompletionResultType]::ParameterName, 'Write to FILE.cast (asciicast), FILE.gif, or numbered from 1 to FILE-%04d.png; - is an asciicast to standard output [default: -]')
            [CompletionResult]::new('--output', '--output', [CompletionResultType]::ParameterName, 'Write to FILE.cast (asciicast), FILE.gif, or numbered from 1 to FILE-%04d.png; - is an asciicast to standard output [default: -]')
            [CompletionResult]::new('--no-config', '--no-config', [CompletionResultType]::ParameterName, 'Read none of the user''s own files')
            [CompletionResult]::new('--compressed-link', '--compressed-link', [CompletionResultType]::ParameterName, 'The link compresses, as ssh -C does: --order raster')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help')
            break
        }
        'termtrace;explain' {
            [CompletionResult]::new('--eye', '--eye', [CompletionResultType]::ParameterName, 'Where to look from, instead of the scene''s eye point')
            [CompletionResult]::new('--target', '--target', [CompletionResultType]::ParameterName, 'Where to look to, instead of the scene''s target')
            [CompletionResult]::new('--up', '--up', [CompletionResultType]::ParameterName, 'What is vertical in the picture, instead of the scene''s up')
            [CompletionResult]::new('--fov', '--fov', [CompletionResultType]::ParameterName, 'The vertical field of view in degrees, instead of the scene''s')
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'How many threads trace [default: as many as there are cores]')
            [CompletionResult]::new('--pixel', '--pixel', [CompletionResultType]::ParameterName, 'The pixel''s column and row, from (0, 0) at the top left')
            [CompletionResult]::new('--size', '--size', [CompletionResultType]::ParameterName, 'The frame''s size in cells [default: 80x24]')
            [CompletionResult]::new('--pixels', '--pixels', [CompletionResultType]::ParameterName, 'The frame''s size in pixels; a cell has two of them, one above the other, or with --glyphs shape two by four')
            [CompletionResult]::new('--cell-aspect', '--cell-aspect', [CompletionResultType]::ParameterName, 'A cell''s height over its width')
            [CompletionResult]::new('--no-config', '--no-config', [CompletionResultType]::ParameterName, 'Read none of the user''s own files')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help')
            break
        }
        'termtrace;check' {
            [CompletionResult]::new('--eye', '--eye', [CompletionResultType]::ParameterName, 'Where to look from, instead of the scene''s eye point')
            [CompletionResult]::new('--target', '--target', [CompletionResultType]::ParameterName, 'Where to look to, instead of the scene''s target')
            [CompletionResult]::new('--up', '--up', [CompletionResultType]::ParameterName, 'What is vertical in the picture, instead of the scene''s up')
            [CompletionResult]::new('--fov', '--fov', [CompletionResultType]::ParameterName, 'The vertical field of view in degrees, instead of the scene''s')
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'How many threads trace [default: as many as there are cores]')
            [CompletionResult]::new('--no-config', '--no-config', [CompletionResultType]::ParameterName, 'Read none of the user''s own files')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help')
            break
        }
        'termtrace;describe' {
            [CompletionResult]::new('--eye', '--eye', [CompletionResultType]::ParameterName, 'Where to look from, instead of the scene''s eye point')
            [CompletionResult]::new('--target', '--target', [CompletionResultType]::ParameterName, 'Where to look to, instead of the scene''s target')
            [CompletionResult]::new('--up', '--up', [CompletionResultType]::ParameterName, 'What is vertical in the picture, instead of the scene''s up')
            [CompletionResult]::new('--fov', '--fov', [CompletionResultType]::ParameterName, 'The vertical field of view in degrees, instead of the scene''s')
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'How many threads trace [default: as many as there are cores]')
            [CompletionResult]::new('--size', '--size', [CompletionResultType]::ParameterName, 'The size of the screen whose picture is told, in cells')
            [CompletionResult]::new('--no-config', '--no-config', [CompletionResultType]::ParameterName, 'Read none of the user''s own files')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help')
            break
        }
        'termtrace;bench' {
            [CompletionResult]::new('--scene', '--scene', [CompletionResultType]::ParameterName, 'A scene that is made rather than read')
            [CompletionResult]::new('--pixels', '--pixels', [CompletionResultType]::ParameterName, 'The picture''s size in pixels')
            [CompletionResult]::new('--samples', '--samples', [CompletionResultType]::ParameterName, 'Rays per pixel')
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'How many threads trace [default: as many as there are cores]')
            [CompletionResult]::new('--kernel', '--kernel', [CompletionResultType]::ParameterName, 'How the rays go through the scene: it changes how long that takes, and nothing else')
            [CompletionResult]::new('--rounds', '--rounds', [CompletionResultType]::ParameterName, 'How many times')
            [CompletionResult]::new('--no-config', '--no-config', [CompletionResultType]::ParameterName, 'Read none of the user''s own files')
            [CompletionResult]::new('--no-shadow', '--no-shadow', [CompletionResultType]::ParameterName, 'Trace no rays to the lights')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'termtrace;doctor' {
            [CompletionResult]::new('--color', '--color', [CompletionResultType]::ParameterName, 'Which colours the picture may have [default: auto]')
            [CompletionResult]::new('--glyphs', '--glyphs', [CompletionResultType]::ParameterName, 'What its cells are made of [default: auto]')
            [CompletionResult]::new('--cell-aspect', '--cell-aspect', [CompletionResultType]::ParameterName, 'A cell''s height over its width [default: as the terminal says, or 2]')
            [CompletionResult]::new('--no-config', '--no-config', [CompletionResultType]::ParameterName, 'Read none of the user''s own files')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help')
            break
        }
        'termtrace;config' {
            [CompletionResult]::new('--color', '--color', [CompletionResultType]::ParameterName, 'Which colours the picture may have [default: auto]')
            [CompletionResult]::new('--glyphs', '--glyphs', [CompletionResultType]::ParameterName, 'What its cells are made of [default: auto]')
            [CompletionResult]::new('--cell-aspect', '--cell-aspect', [CompletionResultType]::ParameterName, 'A cell''s height over its width [default: as the terminal says, or 2]')
            [CompletionResult]::new('--map', '--map', [CompletionResultType]::ParameterName, 'The shaded picture, or a map of the scene [default: shaded]')
            [CompletionResult]::new('--samples', '--samples', [CompletionResultType]::ParameterName, 'Rays per pixel, also in motion, or `best`: 1, and up to 64 where there are edges [default: as many as the time allows, at rest best]')
            [CompletionResult]::new('--quality', '--quality', [CompletionResultType]::ParameterName, 'How near a moving picture is to the right one; it decides bytes, not rays [default: exact; live, on a slow link, equal]')
            [CompletionResult]::new('--max-rate', '--max-rate', [CompletionResultType]::ParameterName, 'The most bytes per second in the mean, such as 50k or 2M; what is most wrong is sent first [default: as many as the link takes]')
            [CompletionResult]::new('--fps', '--fps', [CompletionResultType]::ParameterName, 'The most frames per second [default: 60]')
            [CompletionResult]::new('--move-speed', '--move-speed', [CompletionResultType]::ParameterName, 'How fast keys move the eye: a factor from 0.1 to 10 [default: 1]')
            [CompletionResult]::new('--turn-speed', '--turn-speed', [CompletionResultType]::ParameterName, 'How fast keys turn the view: a factor from 0.1 to 10 [default: 1]')
            [CompletionResult]::new('--reduced-motion', '--reduced-motion', [CompletionResultType]::ParameterName, 'Each press of a key moves one step at once; nothing glides or moves by itself [default: false]')
            [CompletionResult]::new('--no-config', '--no-config', [CompletionResultType]::ParameterName, 'Read none of the user''s own files')
            [CompletionResult]::new('--keys', '--keys', [CompletionResultType]::ParameterName, 'Print what keys do instead, in the form of keys.ron')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help')
            break
        }
        'termtrace;completions' {
            [CompletionResult]::new('--no-config', '--no-config', [CompletionResultType]::ParameterName, 'Read none of the user''s own files')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help')
            break
        }
        'termtrace;man' {
            [CompletionResult]::new('--no-config', '--no-config', [CompletionResultType]::ParameterName, 'Read none of the user''s own files')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help')
            break
        }
    })

    $completions.Where{ $_.CompletionText -like "$wordToComplete*" } |
        Sort-Object -Property ListItemText
}
