
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
            [CompletionResult]::new('--eye', '--eye', [CompletionResultType]::ParameterName, 'Eye point, instead of the scene''s')
            [CompletionResult]::new('--target', '--target', [CompletionResultType]::ParameterName, 'Point that the camera looks at, instead of the scene''s target')
            [CompletionResult]::new('--up', '--up', [CompletionResultType]::ParameterName, 'Up vector, vertical in the picture, instead of the scene''s')
            [CompletionResult]::new('--fov', '--fov', [CompletionResultType]::ParameterName, 'Vertical field of view in degrees, instead of the scene''s')
            [CompletionResult]::new('--shift', '--shift', [CompletionResultType]::ParameterName, 'Shift of the view rectangle to the right and up, in its heights, instead of the scene''s')
            [CompletionResult]::new('--tilt', '--tilt', [CompletionResultType]::ParameterName, 'Tilt of the view rectangle to the right and up in degrees, instead of the scene''s')
            [CompletionResult]::new('--mesh-up', '--mesh-up', [CompletionResultType]::ParameterName, 'Axis of a mesh file that points up [default: y; for STL and PLY a guess]')
            [CompletionResult]::new('--as', '--as', [CompletionResultType]::ParameterName, 'Format of a mesh on standard input [default: by its content]')
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'Number of threads that trace [default: one per core]')
            [CompletionResult]::new('--color', '--color', [CompletionResultType]::ParameterName, 'Colours to draw with [default: auto]')
            [CompletionResult]::new('--glyphs', '--glyphs', [CompletionResultType]::ParameterName, 'Characters to draw with [default: auto]')
            [CompletionResult]::new('--background', '--background', [CompletionResultType]::ParameterName, 'The terminal''s background, for characters without colours and ascii [default: auto: as the terminal reports, or dark]')
            [CompletionResult]::new('--cell-aspect', '--cell-aspect', [CompletionResultType]::ParameterName, 'A cell''s height over its width [default: as detected, or 2]')
            [CompletionResult]::new('--map', '--map', [CompletionResultType]::ParameterName, 'The shaded picture, or a map of the scene [default: shaded]')
            [CompletionResult]::new('--samples', '--samples', [CompletionResultType]::ParameterName, 'Rays per pixel, also in motion; best: up to 64 at edges [default: as many as the time allows; best at rest]')
            [CompletionResult]::new('--quality', '--quality', [CompletionResultType]::ParameterName, 'Fidelity of the picture while it moves: lower sends fewer bytes [default: exact; in casts, and live on a slow link, equal]')
            [CompletionResult]::new('--max-rate', '--max-rate', [CompletionResultType]::ParameterName, 'Limit on the average number of bytes sent per second, such as 50k or 2M [default: the measured rate of the link]')
            [CompletionResult]::new('--moves', '--moves', [CompletionResultType]::ParameterName, 'Whether the terminal moves cells that it shows on a slow link [default: auto]')
            [CompletionResult]::new('--fps', '--fps', [CompletionResultType]::ParameterName, 'Frame-rate cap in frames per second [default: 60]')
            [CompletionResult]::new('--move-speed', '--move-speed', [CompletionResultType]::ParameterName, 'Speed at which keys move the eye: a factor from 0.1 to 10 [default: 1]')
            [CompletionResult]::new('--turn-speed', '--turn-speed', [CompletionResultType]::ParameterName, 'Speed at which keys turn the view: a factor from 0.1 to 10 [default: 1]')
            [CompletionResult]::new('--reduced-motion', '--reduced-motion', [CompletionResultType]::ParameterName, 'Each key press moves one step at once; nothing moves by itself [default: false]')
            [CompletionResult]::new('--hint', '--hint', [CompletionResultType]::ParameterName, 'Show which keys to press, in the lowest row, until the first key press [default: true]')
            [CompletionResult]::new('--order', '--order', [CompletionResultType]::ParameterName, 'Order in which changed cells are sent [default: color; live, raster until the link is found slow]')
            [CompletionResult]::new('--strict', '--strict', [CompletionResultType]::ParameterName, 'Refuse a mesh whose materials or textures are missing, as check does')
            [CompletionResult]::new('--lecture', '--lecture', [CompletionResultType]::ParameterName, 'Draw with the lecture''s model of light only: diffuse surfaces, point sources, clear air')
            [CompletionResult]::new('--compressed-link', '--compressed-link', [CompletionResultType]::ParameterName, 'The link compresses, as ssh -C does: send cells row by row (--order raster)')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Do not print the camera on exit')
            [CompletionResult]::new('--no-config', '--no-config', [CompletionResultType]::ParameterName, 'Ignore config.ron and keys.ron')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('-V', '-V ', [CompletionResultType]::ParameterName, 'Print the version')
            [CompletionResult]::new('--version', '--version', [CompletionResultType]::ParameterName, 'Print the version')
            [CompletionResult]::new('scenes', 'scenes', [CompletionResultType]::ParameterValue, 'List the built-in scenes')
            [CompletionResult]::new('tour', 'tour', [CompletionResultType]::ParameterValue, 'Lead through the built-in scenes, with a caption for each')
            [CompletionResult]::new('new', 'new', [CompletionResultType]::ParameterValue, 'Write a commented starter scene and view it')
            [CompletionResult]::new('frame', 'frame', [CompletionResultType]::ParameterValue, 'Print one frame, or compare it with a golden frame')
            [CompletionResult]::new('record', 'record', [CompletionResultType]::ParameterValue, 'Record a film along a camera path: asciicast, GIF, PNGs')
            [CompletionResult]::new('explain', 'explain', [CompletionResultType]::ParameterValue, 'Explain one pixel: its ray, what it hit, each light')
            [CompletionResult]::new('reference', 'reference', [CompletionResultType]::ParameterValue, 'Print the reference of scene files, or of one name')
            [CompletionResult]::new('check', 'check', [CompletionResultType]::ParameterValue, 'Report every fault of a scene file')
            [CompletionResult]::new('describe', 'describe', [CompletionResultType]::ParameterValue, 'Describe a picture in words')
            [CompletionResult]::new('bench', 'bench', [CompletionResultType]::ParameterValue, 'Measure how fast a scene is traced')
            [CompletionResult]::new('serve', 'serve', [CompletionResultType]::ParameterValue, 'Show scenes to everyone who connects by SSH')
            [CompletionResult]::new('doctor', 'doctor', [CompletionResultType]::ParameterValue, 'Show what was detected about this terminal, and a test card')
            [CompletionResult]::new('config', 'config', [CompletionResultType]::ParameterValue, 'Show the effective settings and where each comes from')
            [CompletionResult]::new('completions', 'completions', [CompletionResultType]::ParameterValue, 'Print shell completions')
            [CompletionResult]::new('man', 'man', [CompletionResultType]::ParameterValue, 'Print the man page')
            [CompletionResult]::new('help', 'help', [CompletionResultType]::ParameterValue, 'Print the help of a command')
            [CompletionResult]::new('version', 'version', [CompletionResultType]::ParameterValue, 'Print the version')
            break
        }
        'termtrace;scenes' {
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--no-config', '--no-config', [CompletionResultType]::ParameterName, 'no-config')
            break
        }
        'termtrace;tour' {
            [CompletionResult]::new('--color', '--color', [CompletionResultType]::ParameterName, 'Colours to draw with [default: auto]')
            [CompletionResult]::new('--glyphs', '--glyphs', [CompletionResultType]::ParameterName, 'Characters to draw with [default: auto]')
            [CompletionResult]::new('--background', '--background', [CompletionResultType]::ParameterName, 'The terminal''s background, for characters without colours and ascii [default: auto: as the terminal reports, or dark]')
            [CompletionResult]::new('--cell-aspect', '--cell-aspect', [CompletionResultType]::ParameterName, 'A cell''s height over its width [default: as detected, or 2]')
            [CompletionResult]::new('--map', '--map', [CompletionResultType]::ParameterName, 'The shaded picture, or a map of the scene [default: shaded]')
            [CompletionResult]::new('--samples', '--samples', [CompletionResultType]::ParameterName, 'Rays per pixel, also in motion; best: up to 64 at edges [default: as many as the time allows; best at rest]')
            [CompletionResult]::new('--quality', '--quality', [CompletionResultType]::ParameterName, 'Fidelity of the picture while it moves: lower sends fewer bytes [default: exact; in casts, and live on a slow link, equal]')
            [CompletionResult]::new('--max-rate', '--max-rate', [CompletionResultType]::ParameterName, 'Limit on the average number of bytes sent per second, such as 50k or 2M [default: the measured rate of the link]')
            [CompletionResult]::new('--moves', '--moves', [CompletionResultType]::ParameterName, 'Whether the terminal moves cells that it shows on a slow link [default: auto]')
            [CompletionResult]::new('--fps', '--fps', [CompletionResultType]::ParameterName, 'Frame-rate cap in frames per second [default: 60]')
            [CompletionResult]::new('--move-speed', '--move-speed', [CompletionResultType]::ParameterName, 'Speed at which keys move the eye: a factor from 0.1 to 10 [default: 1]')
            [CompletionResult]::new('--turn-speed', '--turn-speed', [CompletionResultType]::ParameterName, 'Speed at which keys turn the view: a factor from 0.1 to 10 [default: 1]')
            [CompletionResult]::new('--reduced-motion', '--reduced-motion', [CompletionResultType]::ParameterName, 'Each key press moves one step at once; nothing moves by itself [default: false]')
            [CompletionResult]::new('--hint', '--hint', [CompletionResultType]::ParameterName, 'Show which keys to press, in the lowest row, until the first key press [default: true]')
            [CompletionResult]::new('--order', '--order', [CompletionResultType]::ParameterName, 'Order in which changed cells are sent [default: color; live, raster until the link is found slow]')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--compressed-link', '--compressed-link', [CompletionResultType]::ParameterName, 'The link compresses, as ssh -C does: send cells row by row (--order raster)')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Do not print the camera on exit')
            [CompletionResult]::new('--no-config', '--no-config', [CompletionResultType]::ParameterName, 'no-config')
            break
        }
        'termtrace;new' {
            [CompletionResult]::new('--formula', '--formula', [CompletionResultType]::ParameterName, 'Formula of a surface, instead of the starter scene')
            [CompletionResult]::new('--color', '--color', [CompletionResultType]::ParameterName, 'Colours to draw with [default: auto]')
            [CompletionResult]::new('--glyphs', '--glyphs', [CompletionResultType]::ParameterName, 'Characters to draw with [default: auto]')
            [CompletionResult]::new('--background', '--background', [CompletionResultType]::ParameterName, 'The terminal''s background, for characters without colours and ascii [default: auto: as the terminal reports, or dark]')
            [CompletionResult]::new('--cell-aspect', '--cell-aspect', [CompletionResultType]::ParameterName, 'A cell''s height over its width [default: as detected, or 2]')
            [CompletionResult]::new('--map', '--map', [CompletionResultType]::ParameterName, 'The shaded picture, or a map of the scene [default: shaded]')
            [CompletionResult]::new('--samples', '--samples', [CompletionResultType]::ParameterName, 'Rays per pixel, also in motion; best: up to 64 at edges [default: as many as the time allows; best at rest]')
            [CompletionResult]::new('--quality', '--quality', [CompletionResultType]::ParameterName, 'Fidelity of the picture while it moves: lower sends fewer bytes [default: exact; in casts, and live on a slow link, equal]')
            [CompletionResult]::new('--max-rate', '--max-rate', [CompletionResultType]::ParameterName, 'Limit on the average number of bytes sent per second, such as 50k or 2M [default: the measured rate of the link]')
            [CompletionResult]::new('--moves', '--moves', [CompletionResultType]::ParameterName, 'Whether the terminal moves cells that it shows on a slow link [default: auto]')
            [CompletionResult]::new('--fps', '--fps', [CompletionResultType]::ParameterName, 'Frame-rate cap in frames per second [default: 60]')
            [CompletionResult]::new('--move-speed', '--move-speed', [CompletionResultType]::ParameterName, 'Speed at which keys move the eye: a factor from 0.1 to 10 [default: 1]')
            [CompletionResult]::new('--turn-speed', '--turn-speed', [CompletionResultType]::ParameterName, 'Speed at which keys turn the view: a factor from 0.1 to 10 [default: 1]')
            [CompletionResult]::new('--reduced-motion', '--reduced-motion', [CompletionResultType]::ParameterName, 'Each key press moves one step at once; nothing moves by itself [default: false]')
            [CompletionResult]::new('--hint', '--hint', [CompletionResultType]::ParameterName, 'Show which keys to press, in the lowest row, until the first key press [default: true]')
            [CompletionResult]::new('--order', '--order', [CompletionResultType]::ParameterName, 'Order in which changed cells are sent [default: color; live, raster until the link is found slow]')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--compressed-link', '--compressed-link', [CompletionResultType]::ParameterName, 'The link compresses, as ssh -C does: send cells row by row (--order raster)')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Do not print the camera on exit')
            [CompletionResult]::new('--no-config', '--no-config', [CompletionResultType]::ParameterName, 'no-config')
            break
        }
        'termtrace;frame' {
            [CompletionResult]::new('--eye', '--eye', [CompletionResultType]::ParameterName, 'Eye point, instead of the scene''s')
            [CompletionResult]::new('--target', '--target', [CompletionResultType]::ParameterName, 'Point that the camera looks at, instead of the scene''s target')
            [CompletionResult]::new('--up', '--up', [CompletionResultType]::ParameterName, 'Up vector, vertical in the picture, instead of the scene''s')
            [CompletionResult]::new('--fov', '--fov', [CompletionResultType]::ParameterName, 'Vertical field of view in degrees, instead of the scene''s')
            [CompletionResult]::new('--shift', '--shift', [CompletionResultType]::ParameterName, 'Shift of the view rectangle to the right and up, in its heights, instead of the scene''s')
            [CompletionResult]::new('--tilt', '--tilt', [CompletionResultType]::ParameterName, 'Tilt of the view rectangle to the right and up in degrees, instead of the scene''s')
            [CompletionResult]::new('--mesh-up', '--mesh-up', [CompletionResultType]::ParameterName, 'Axis of a mesh file that points up [default: y; for STL and PLY a guess]')
            [CompletionResult]::new('--as', '--as', [CompletionResultType]::ParameterName, 'Format of a mesh on standard input [default: by its content]')
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'Number of threads that trace [default: one per core]')
            [CompletionResult]::new('--time', '--time', [CompletionResultType]::ParameterName, 'Seconds to which a moving scene is set')
            [CompletionResult]::new('--size', '--size', [CompletionResultType]::ParameterName, 'The frame''s size in cells [default: 80x24]')
            [CompletionResult]::new('--pixels', '--pixels', [CompletionResultType]::ParameterName, 'Size in pixels [default: PNG 1280x800, GIF 480x300]')
            [CompletionResult]::new('--cell-aspect', '--cell-aspect', [CompletionResultType]::ParameterName, 'A cell''s height over its width')
            [CompletionResult]::new('--samples', '--samples', [CompletionResultType]::ParameterName, 'Rays per pixel; best: 1 to 64 [default: 1; PNG, GIF: best]')
            [CompletionResult]::new('--scale', '--scale', [CompletionResultType]::ParameterName, 'Picture files: draw each pixel as N by N pixels of the file [default: 1]')
            [CompletionResult]::new('--map', '--map', [CompletionResultType]::ParameterName, 'The shaded picture, or a map of the scene [default: shaded]')
            [CompletionResult]::new('--color', '--color', [CompletionResultType]::ParameterName, 'Colours to draw with [default: auto]')
            [CompletionResult]::new('--glyphs', '--glyphs', [CompletionResultType]::ParameterName, 'Characters to draw with [default: auto]')
            [CompletionResult]::new('--background', '--background', [CompletionResultType]::ParameterName, 'The terminal''s background, for characters without colours and ascii [default: auto: as the terminal reports, or dark]')
            [CompletionResult]::new('--format', '--format', [CompletionResultType]::ParameterName, 'Format to write [default: by the file name''s extension, or text]')
            [CompletionResult]::new('-o', '-o', [CompletionResultType]::ParameterName, 'Write to a file; - is standard output [default: -]')
            [CompletionResult]::new('--output', '--output', [CompletionResultType]::ParameterName, 'Write to a file; - is standard output [default: -]')
            [CompletionResult]::new('--check', '--check', [CompletionResultType]::ParameterName, 'Compare with the frame in a file, and print a diff')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--strict', '--strict', [CompletionResultType]::ParameterName, 'Refuse a mesh whose materials or textures are missing, as check does')
            [CompletionResult]::new('--lecture', '--lecture', [CompletionResultType]::ParameterName, 'Draw with the lecture''s model of light only: diffuse surfaces, point sources, clear air')
            [CompletionResult]::new('--bless', '--bless', [CompletionResultType]::ParameterName, 'With --check: write the golden frame instead of comparing')
            [CompletionResult]::new('--no-config', '--no-config', [CompletionResultType]::ParameterName, 'no-config')
            break
        }
        'termtrace;record' {
            [CompletionResult]::new('--eye', '--eye', [CompletionResultType]::ParameterName, 'Eye point, instead of the scene''s')
            [CompletionResult]::new('--target', '--target', [CompletionResultType]::ParameterName, 'Point that the camera looks at, instead of the scene''s target')
            [CompletionResult]::new('--up', '--up', [CompletionResultType]::ParameterName, 'Up vector, vertical in the picture, instead of the scene''s')
            [CompletionResult]::new('--fov', '--fov', [CompletionResultType]::ParameterName, 'Vertical field of view in degrees, instead of the scene''s')
            [CompletionResult]::new('--shift', '--shift', [CompletionResultType]::ParameterName, 'Shift of the view rectangle to the right and up, in its heights, instead of the scene''s')
            [CompletionResult]::new('--tilt', '--tilt', [CompletionResultType]::ParameterName, 'Tilt of the view rectangle to the right and up in degrees, instead of the scene''s')
            [CompletionResult]::new('--mesh-up', '--mesh-up', [CompletionResultType]::ParameterName, 'Axis of a mesh file that points up [default: y; for STL and PLY a guess]')
            [CompletionResult]::new('--as', '--as', [CompletionResultType]::ParameterName, 'Format of a mesh on standard input [default: by its content]')
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'Number of threads that trace [default: one per core]')
            [CompletionResult]::new('--time', '--time', [CompletionResultType]::ParameterName, 'Seconds to which a moving scene is set')
            [CompletionResult]::new('--path', '--path', [CompletionResultType]::ParameterName, 'The orbit, or a file of keyframes')
            [CompletionResult]::new('--seconds', '--seconds', [CompletionResultType]::ParameterName, 'Length in seconds [default: 8, or the path''s]')
            [CompletionResult]::new('--fps', '--fps', [CompletionResultType]::ParameterName, 'Frames per second [default: 30; GIF: 25]')
            [CompletionResult]::new('--size', '--size', [CompletionResultType]::ParameterName, 'The frame''s size in cells [default: 80x24]')
            [CompletionResult]::new('--pixels', '--pixels', [CompletionResultType]::ParameterName, 'Size in pixels [default: PNG 1280x800, GIF 480x300]')
            [CompletionResult]::new('--cell-aspect', '--cell-aspect', [CompletionResultType]::ParameterName, 'A cell''s height over its width')
            [CompletionResult]::new('--samples', '--samples', [CompletionResultType]::ParameterName, 'Rays per pixel; best: 1 to 64 [default: 1; PNG, GIF: best]')
            [CompletionResult]::new('--scale', '--scale', [CompletionResultType]::ParameterName, 'Picture files: draw each pixel as N by N pixels of the file [default: 1]')
            [CompletionResult]::new('--map', '--map', [CompletionResultType]::ParameterName, 'The shaded picture, or a map of the scene [default: shaded]')
            [CompletionResult]::new('--glyphs', '--glyphs', [CompletionResultType]::ParameterName, 'Characters of an asciicast: as for frame [default: half]')
            [CompletionResult]::new('--order', '--order', [CompletionResultType]::ParameterName, 'Order in which changed cells are sent [default: color; live, raster until the link is found slow]')
            [CompletionResult]::new('--quality', '--quality', [CompletionResultType]::ParameterName, 'Fidelity of the picture while it moves: lower sends fewer bytes [default: exact; in casts, and live on a slow link, equal]')
            [CompletionResult]::new('--max-rate', '--max-rate', [CompletionResultType]::ParameterName, 'Limit on the average number of bytes sent per second, such as 50k or 2M [default: the measured rate of the link]')
            [CompletionResult]::new('-o', '-o', [CompletionResultType]::ParameterName, 'FILE.cast (asciicast), FILE.gif, or FILE-%04d.png')
            [CompletionResult]::new('--output', '--output', [CompletionResultType]::ParameterName, 'FILE.cast (asciicast), FILE.gif, or FILE-%04d.png')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--strict', '--strict', [CompletionResultType]::ParameterName, 'Refuse a mesh whose materials or textures are missing, as check does')
            [CompletionResult]::new('--lecture', '--lecture', [CompletionResultType]::ParameterName, 'Draw with the lecture''s model of light only: diffuse surfaces, point sources, clear air')
            [CompletionResult]::new('--compressed-link', '--compressed-link', [CompletionResultType]::ParameterName, 'The link compresses, as ssh -C does: send cells row by row (--order raster)')
            [CompletionResult]::new('--no-config', '--no-config', [CompletionResultType]::ParameterName, 'no-config')
            break
        }
        'termtrace;explain' {
            [CompletionResult]::new('--eye', '--eye', [CompletionResultType]::ParameterName, 'Eye point, instead of the scene''s')
            [CompletionResult]::new('--target', '--target', [CompletionResultType]::ParameterName, 'Point that the camera looks at, instead of the scene''s target')
            [CompletionResult]::new('--up', '--up', [CompletionResultType]::ParameterName, 'Up vector, vertical in the picture, instead of the scene''s')
            [CompletionResult]::new('--fov', '--fov', [CompletionResultType]::ParameterName, 'Vertical field of view in degrees, instead of the scene''s')
            [CompletionResult]::new('--shift', '--shift', [CompletionResultType]::ParameterName, 'Shift of the view rectangle to the right and up, in its heights, instead of the scene''s')
            [CompletionResult]::new('--tilt', '--tilt', [CompletionResultType]::ParameterName, 'Tilt of the view rectangle to the right and up in degrees, instead of the scene''s')
            [CompletionResult]::new('--mesh-up', '--mesh-up', [CompletionResultType]::ParameterName, 'Axis of a mesh file that points up [default: y; for STL and PLY a guess]')
            [CompletionResult]::new('--as', '--as', [CompletionResultType]::ParameterName, 'Format of a mesh on standard input [default: by its content]')
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'Number of threads that trace [default: one per core]')
            [CompletionResult]::new('--time', '--time', [CompletionResultType]::ParameterName, 'Seconds to which a moving scene is set')
            [CompletionResult]::new('--pixel', '--pixel', [CompletionResultType]::ParameterName, 'The pixel''s column and row, from (0, 0) at the top left')
            [CompletionResult]::new('--size', '--size', [CompletionResultType]::ParameterName, 'The frame''s size in cells [default: 80x24]')
            [CompletionResult]::new('--pixels', '--pixels', [CompletionResultType]::ParameterName, 'Size in pixels [default: PNG 1280x800, GIF 480x300]')
            [CompletionResult]::new('--cell-aspect', '--cell-aspect', [CompletionResultType]::ParameterName, 'A cell''s height over its width')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--strict', '--strict', [CompletionResultType]::ParameterName, 'Refuse a mesh whose materials or textures are missing, as check does')
            [CompletionResult]::new('--lecture', '--lecture', [CompletionResultType]::ParameterName, 'Draw with the lecture''s model of light only: diffuse surfaces, point sources, clear air')
            [CompletionResult]::new('--json', '--json', [CompletionResultType]::ParameterName, 'Print JSON')
            [CompletionResult]::new('--no-config', '--no-config', [CompletionResultType]::ParameterName, 'no-config')
            break
        }
        'termtrace;reference' {
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--no-config', '--no-config', [CompletionResultType]::ParameterName, 'no-config')
            break
        }
        'termtrace;check' {
            [CompletionResult]::new('--eye', '--eye', [CompletionResultType]::ParameterName, 'Eye point, instead of the scene''s')
            [CompletionResult]::new('--target', '--target', [CompletionResultType]::ParameterName, 'Point that the camera looks at, instead of the scene''s target')
            [CompletionResult]::new('--up', '--up', [CompletionResultType]::ParameterName, 'Up vector, vertical in the picture, instead of the scene''s')
            [CompletionResult]::new('--fov', '--fov', [CompletionResultType]::ParameterName, 'Vertical field of view in degrees, instead of the scene''s')
            [CompletionResult]::new('--shift', '--shift', [CompletionResultType]::ParameterName, 'Shift of the view rectangle to the right and up, in its heights, instead of the scene''s')
            [CompletionResult]::new('--tilt', '--tilt', [CompletionResultType]::ParameterName, 'Tilt of the view rectangle to the right and up in degrees, instead of the scene''s')
            [CompletionResult]::new('--mesh-up', '--mesh-up', [CompletionResultType]::ParameterName, 'Axis of a mesh file that points up [default: y; for STL and PLY a guess]')
            [CompletionResult]::new('--as', '--as', [CompletionResultType]::ParameterName, 'Format of a mesh on standard input [default: by its content]')
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'Number of threads that trace [default: one per core]')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--strict', '--strict', [CompletionResultType]::ParameterName, 'Refuse a mesh whose materials or textures are missing, as check does')
            [CompletionResult]::new('--lecture', '--lecture', [CompletionResultType]::ParameterName, 'Draw with the lecture''s model of light only: diffuse surfaces, point sources, clear air')
            [CompletionResult]::new('--no-config', '--no-config', [CompletionResultType]::ParameterName, 'no-config')
            break
        }
        'termtrace;describe' {
            [CompletionResult]::new('--eye', '--eye', [CompletionResultType]::ParameterName, 'Eye point, instead of the scene''s')
            [CompletionResult]::new('--target', '--target', [CompletionResultType]::ParameterName, 'Point that the camera looks at, instead of the scene''s target')
            [CompletionResult]::new('--up', '--up', [CompletionResultType]::ParameterName, 'Up vector, vertical in the picture, instead of the scene''s')
            [CompletionResult]::new('--fov', '--fov', [CompletionResultType]::ParameterName, 'Vertical field of view in degrees, instead of the scene''s')
            [CompletionResult]::new('--shift', '--shift', [CompletionResultType]::ParameterName, 'Shift of the view rectangle to the right and up, in its heights, instead of the scene''s')
            [CompletionResult]::new('--tilt', '--tilt', [CompletionResultType]::ParameterName, 'Tilt of the view rectangle to the right and up in degrees, instead of the scene''s')
            [CompletionResult]::new('--mesh-up', '--mesh-up', [CompletionResultType]::ParameterName, 'Axis of a mesh file that points up [default: y; for STL and PLY a guess]')
            [CompletionResult]::new('--as', '--as', [CompletionResultType]::ParameterName, 'Format of a mesh on standard input [default: by its content]')
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'Number of threads that trace [default: one per core]')
            [CompletionResult]::new('--time', '--time', [CompletionResultType]::ParameterName, 'Seconds to which a moving scene is set')
            [CompletionResult]::new('--size', '--size', [CompletionResultType]::ParameterName, 'The size of the screen, in cells')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--strict', '--strict', [CompletionResultType]::ParameterName, 'Refuse a mesh whose materials or textures are missing, as check does')
            [CompletionResult]::new('--lecture', '--lecture', [CompletionResultType]::ParameterName, 'Draw with the lecture''s model of light only: diffuse surfaces, point sources, clear air')
            [CompletionResult]::new('--json', '--json', [CompletionResultType]::ParameterName, 'Print JSON')
            [CompletionResult]::new('--no-config', '--no-config', [CompletionResultType]::ParameterName, 'no-config')
            break
        }
        'termtrace;bench' {
            [CompletionResult]::new('--scene', '--scene', [CompletionResultType]::ParameterName, 'A generated scene instead of a file')
            [CompletionResult]::new('--pixels', '--pixels', [CompletionResultType]::ParameterName, 'The picture''s size in pixels')
            [CompletionResult]::new('--samples', '--samples', [CompletionResultType]::ParameterName, 'Rays per pixel')
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'Number of threads that trace [default: one per core]')
            [CompletionResult]::new('--kernel', '--kernel', [CompletionResultType]::ParameterName, 'How rays are traced through the scene; affects the time only')
            [CompletionResult]::new('--algorithm', '--algorithm', [CompletionResultType]::ParameterName, 'Image order or object order')
            [CompletionResult]::new('--rounds', '--rounds', [CompletionResultType]::ParameterName, 'Number of rounds')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--no-shadow', '--no-shadow', [CompletionResultType]::ParameterName, 'Trace no shadow rays')
            [CompletionResult]::new('--json', '--json', [CompletionResultType]::ParameterName, 'Print JSON')
            [CompletionResult]::new('--no-config', '--no-config', [CompletionResultType]::ParameterName, 'no-config')
            break
        }
        'termtrace;serve' {
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--no-config', '--no-config', [CompletionResultType]::ParameterName, 'no-config')
            break
        }
        'termtrace;doctor' {
            [CompletionResult]::new('--color', '--color', [CompletionResultType]::ParameterName, 'Colours to draw with [default: auto]')
            [CompletionResult]::new('--glyphs', '--glyphs', [CompletionResultType]::ParameterName, 'Characters to draw with [default: auto]')
            [CompletionResult]::new('--background', '--background', [CompletionResultType]::ParameterName, 'The terminal''s background, for characters without colours and ascii [default: auto: as the terminal reports, or dark]')
            [CompletionResult]::new('--cell-aspect', '--cell-aspect', [CompletionResultType]::ParameterName, 'A cell''s height over its width [default: as detected, or 2]')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--no-config', '--no-config', [CompletionResultType]::ParameterName, 'Ignore config.ron and keys.ron')
            [CompletionResult]::new('--json', '--json', [CompletionResultType]::ParameterName, 'Print JSON')
            break
        }
        'termtrace;config' {
            [CompletionResult]::new('--color', '--color', [CompletionResultType]::ParameterName, 'Colours to draw with [default: auto]')
            [CompletionResult]::new('--glyphs', '--glyphs', [CompletionResultType]::ParameterName, 'Characters to draw with [default: auto]')
            [CompletionResult]::new('--background', '--background', [CompletionResultType]::ParameterName, 'The terminal''s background, for characters without colours and ascii [default: auto: as the terminal reports, or dark]')
            [CompletionResult]::new('--cell-aspect', '--cell-aspect', [CompletionResultType]::ParameterName, 'A cell''s height over its width [default: as detected, or 2]')
            [CompletionResult]::new('--map', '--map', [CompletionResultType]::ParameterName, 'The shaded picture, or a map of the scene [default: shaded]')
            [CompletionResult]::new('--samples', '--samples', [CompletionResultType]::ParameterName, 'Rays per pixel, also in motion; best: up to 64 at edges [default: as many as the time allows; best at rest]')
            [CompletionResult]::new('--quality', '--quality', [CompletionResultType]::ParameterName, 'Fidelity of the picture while it moves: lower sends fewer bytes [default: exact; in casts, and live on a slow link, equal]')
            [CompletionResult]::new('--max-rate', '--max-rate', [CompletionResultType]::ParameterName, 'Limit on the average number of bytes sent per second, such as 50k or 2M [default: the measured rate of the link]')
            [CompletionResult]::new('--moves', '--moves', [CompletionResultType]::ParameterName, 'Whether the terminal moves cells that it shows on a slow link [default: auto]')
            [CompletionResult]::new('--fps', '--fps', [CompletionResultType]::ParameterName, 'Frame-rate cap in frames per second [default: 60]')
            [CompletionResult]::new('--move-speed', '--move-speed', [CompletionResultType]::ParameterName, 'Speed at which keys move the eye: a factor from 0.1 to 10 [default: 1]')
            [CompletionResult]::new('--turn-speed', '--turn-speed', [CompletionResultType]::ParameterName, 'Speed at which keys turn the view: a factor from 0.1 to 10 [default: 1]')
            [CompletionResult]::new('--reduced-motion', '--reduced-motion', [CompletionResultType]::ParameterName, 'Each key press moves one step at once; nothing moves by itself [default: false]')
            [CompletionResult]::new('--hint', '--hint', [CompletionResultType]::ParameterName, 'Show which keys to press, in the lowest row, until the first key press [default: true]')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--no-config', '--no-config', [CompletionResultType]::ParameterName, 'Ignore config.ron and keys.ron')
            [CompletionResult]::new('--keys', '--keys', [CompletionResultType]::ParameterName, 'Print the keys instead, in the form of keys.ron')
            [CompletionResult]::new('--json', '--json', [CompletionResultType]::ParameterName, 'Print JSON')
            break
        }
        'termtrace;completions' {
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--no-config', '--no-config', [CompletionResultType]::ParameterName, 'no-config')
            break
        }
        'termtrace;man' {
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--no-config', '--no-config', [CompletionResultType]::ParameterName, 'no-config')
            break
        }
        'termtrace;help' {
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--no-config', '--no-config', [CompletionResultType]::ParameterName, 'no-config')
            break
        }
        'termtrace;version' {
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help; -h prints a summary')
            [CompletionResult]::new('--no-config', '--no-config', [CompletionResultType]::ParameterName, 'no-config')
            break
        }
    })

    $completions.Where{ $_.CompletionText -like "$wordToComplete*" } |
        Sort-Object -Property ListItemText
}
