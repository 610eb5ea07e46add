# SPDX-License-Identifier: GPL-3.0-or-later
"""German, in the terms of Blender's German interface."""

TEXTS = {
    # Settings
    "Indirect Light": "Indirekte Beleuchtung",
    "Add indirect light to EEVEE renders, computed from the passes of the finished frame. It cannot be animated: to"
    " fade the light, animate Strength": (
        "EEVEE-Renderings indirektes Licht hinzufügen, das aus den Passes des fertigen Bildes berechnet wird. Nicht "
        "animierbar: Zum Ein- und Ausblenden die Stärke animieren"
    ),
    "Method": "Verfahren",
    "How indirect light is computed. Determines accuracy and render time": (
        "Wie indirektes Licht berechnet wird. Bestimmt Genauigkeit und Renderzeit"
    ),
    "Paper": "Paper",
    "One bounce between surfaces that the camera sees, without occlusion. Fastest": (
        "Eine Reflexion zwischen Flächen im Bild der Kamera, ohne Verdeckung. Am schnellsten"
    ),
    "Radiosity": "Radiosity",
    "Several bounces between surfaces that any of the views sees, with occlusion. Closest to Cycles": (
        "Mehrere Reflexionen zwischen Flächen in allen Ansichten, mit Verdeckung. Am nächsten an Cycles"
    ),
    "Strength": "Stärke",
    "Factor on the indirect light. 1 is physically correct. It is applied to linear light, so exposure and view "
    "transform do not change its meaning. No cost": (
        "Faktor für das indirekte Licht. 1 ist physikalisch korrekt. Er gilt für lineares Licht, daher ändern "
        "Belichtung und Ansichtstransformation seine Bedeutung nicht. Kostet keine Zeit"
    ),
    "Viewport": "Ansichtsfenster",
    "Show indirect light in viewports with Rendered shading. After each change EEVEE's passes are drawn again as "
    "five small images and the light is refined until it is free of noise; after that there is no cost. Glossy "
    "Light is not shown": (
        "Indirektes Licht in gerenderten Ansichtsfenstern zeigen. Nach jeder Änderung werden EEVEEs Passes als fünf "
        "kleine Bilder neu gezeichnet, und das Licht wird verfeinert, bis es rauschfrei ist; danach kostet es keine "
        "Zeit mehr. Glänzendes Licht wird nicht gezeigt"
    ),
    "Start Resolution": "Startauflösung",
    "Finest resolution at which indirect light is computed. Each step up takes four times as long and sharpens the "
    "light near edges and contacts. It does not change the brightness": (
        "Feinste Auflösung, in der indirektes Licht berechnet wird. Jede Stufe dauert viermal so lange und schärft das"
        " Licht an Kanten und Berührungsstellen. Die Helligkeit ändert sich nicht"
    ),
    "Quarter": "Viertel",
    "One texel per 4 x 4 pixels. Fastest, blurry where objects touch": (
        "Ein Texel je 4 x 4 Pixel. Am schnellsten, unscharf an Berührungsstellen"
    ),
    "Half": "Halb",
    "One texel per 2 x 2 pixels. Four times the cost of Quarter": (
        "Ein Texel je 2 x 2 Pixel. Viermal so teuer wie Viertel"
    ),
    "Full": "Voll",
    "One texel per pixel. Sixteen times the cost of Quarter": "Ein Texel je Pixel. Sechzehnmal so teuer wie Viertel",
    "Samples": "Abtastwerte",
    "Random samples per texel at the finest level, twice as many at each coarser level, where noise is most "
    "visible. Time is proportional, noise falls with the square root. Where the radius holds fewer texels, each is "
    "sampled once and there is no noise": (
        "Zufällige Abtastwerte je Texel auf der feinsten Ebene, doppelt so viele auf jeder gröberen, wo Rauschen am "
        "meisten auffällt. Die Zeit ist proportional, das Rauschen sinkt mit der Wurzel. Umfasst der Radius weniger "
        "Texel, wird jedes einmal abgetastet, und es gibt kein Rauschen"
    ),
    "Radius": "Radius",
    "Radius of the disk that is sampled at each level, in texels of that level. A larger radius is closer to the "
    "exact sum over all pixels but noisier, since the samples are spread over more texels. Time depends mostly on "
    "Samples": (
        "Radius der Scheibe, die auf jeder Ebene abgetastet wird, in Texeln dieser Ebene. Ein größerer Radius kommt "
        "der genauen Summe über alle Pixel näher, rauscht aber stärker, weil sich die Abtastwerte auf mehr Texel "
        "verteilen. Die Zeit hängt vor allem von den Abtastwerten ab"
    ),
    "Draws": "Ziehungen",
    "Visibility-tested light samples per texel; each is picked from 16 candidates. Time is proportional, noise "
    "falls with the square root": (
        "Auf Verdeckung geprüfte Lichtabtastungen je Texel; jede wird aus 16 Kandidaten gewählt. Die Zeit ist "
        "proportional, das Rauschen sinkt mit der Wurzel"
    ),
    "Accumulate": "Aufsummieren",
    "Number of independent gathers averaged per frame. Time is proportional, noise falls with the square root": (
        "Anzahl unabhängiger Berechnungen des Lichts, die je Bild gemittelt werden. Die Zeit ist proportional, das "
        "Rauschen sinkt mit der Wurzel"
    ),
    "Average Frames": "Einzelbilder mitteln",
    "In animations, average the light of each frame with that of the frames before, where they show the same "
    "surface. Noise falls to a third at no cost, except for the first frame of a render, which takes nine gathers "
    "instead of one. Changes of the light take a few frames to show in full. Single renders are not affected": (
        "In Animationen das Licht jedes Einzelbildes mit dem der vorigen mitteln, wo diese dieselbe Fläche zeigen. Das"
        " Rauschen sinkt ohne Mehrkosten auf ein Drittel; nur für das erste Bild eines Renderings wird das Licht "
        "neunmal statt einmal berechnet. Änderungen des Lichts sind nach wenigen Bildern ganz zu sehen. Standbilder "
        "bleiben unverändert"
    ),
    "Denoise": "Entrauschen",
    "How noise is removed from the indirect light. Takes little time compared to the gather": (
        "Wie das Rauschen aus dem indirekten Licht entfernt wird. Dauert kurz im Vergleich zur Berechnung des Lichts"
    ),
    "None": "Aus",
    "Leave the noise in": "Das Rauschen nicht entfernen",
    "Smooth": "Glätten",
    "Average neighboring texels along surfaces": "Benachbarte Texel auf derselben Fläche mitteln",
    "Denoise Node": "Entrauschen-Node",
    "Blender's Denoise node for the indirect light, in the compositor. The error is a tenth lower than with Smooth "
    "if Start Resolution is Full. Noise of coarser resolutions remains": (
        "Blenders Entrauschen-Node für das indirekte Licht, im Compositor. Mit der Startauflösung Voll ist der Fehler "
        "um ein Zehntel kleiner als mit Glätten. Das Rauschen gröberer Auflösungen bleibt"
    ),
    "Bounces": "Reflexionen",
    "Number of bounces of indirect light. Rooms with bright walls need more. Each takes a little time, regardless "
    "of the resolution. Automatic views are placed for the first 4 bounces": (
        "Anzahl der Reflexionen des indirekten Lichts. Räume mit hellen Wänden brauchen mehr. Jede kostet ein wenig "
        "Zeit, unabhängig von der Auflösung. Automatische Ansichten werden für die ersten 4 Reflexionen platziert"
    ),
    "Visibility": "Verdeckung",
    "Let surfaces block indirect light. Without it light passes through everything and furnished rooms get too "
    "bright, but the gather takes about half the time": (
        "Flächen blockieren indirektes Licht. Ohne Verdeckung geht Licht durch alles hindurch, und möblierte Räume "
        "werden zu hell, aber die Berechnung dauert nur etwa halb so lange"
    ),
    "Shadow World": "Welt abschatten",
    "Let surfaces block the light of the world, which EEVEE lets through walls. Works for worlds with a single "
    "color or an environment texture. Needs Visibility. No cost": (
        "Flächen blockieren das Licht der Welt, das bei EEVEE durch Wände dringt. Für Welten mit einer einzigen Farbe "
        "oder einer Umgebungstextur. Benötigt Verdeckung. Kostet keine Zeit"
    ),
    "Glossy Light": "Glänzendes Licht",
    "Let glossy surfaces reflect indirect light and the surfaces that the views see. Adds half to the time of the "
    "gather, and three passes to EEVEE": (
        "Glänzende Flächen reflektieren indirektes Licht und die Flächen in den Ansichten. Verlängert die Berechnung "
        "um die Hälfte und braucht drei zusätzliche Passes von EEVEE"
    ),
    "Seed": "Startwert",
    "Pattern of the noise. The same seed gives exactly the same image. Has no effect if there are enough samples to"
    " leave no noise. No cost": (
        "Muster des Rauschens. Derselbe Startwert ergibt genau dasselbe Bild. Ohne Wirkung, wenn es bei genügend "
        "Abtastwerten kein Rauschen gibt. Kostet keine Zeit"
    ),
    "Animate Seed": "Startwert animieren",
    "Change the pattern of the noise in each frame, so that it does not stick to the image when the camera moves. "
    "No cost": (
        "Das Muster des Rauschens in jedem Einzelbild ändern, damit es bei bewegter Kamera nicht am Bild klebt. Kostet"
        " keine Zeit"
    ),
    # Views
    "Views": "Ansichten",
    "View": "Ansicht",
    "Which cameras capture light-emitting surfaces. Surfaces that no camera sees emit nothing. Each further view "
    "costs the time of one EEVEE sample": (
        "Welche Kameras die Flächen erfassen, die Licht aussenden. Flächen, die keine Kamera sieht, senden keines aus."
        " Jede weitere Ansicht kostet die Zeit eines EEVEE-Samples"
    ),
    "Camera Only": "Nur Kamera",
    "The scene's camera alone. Fastest, without light from outside the image": (
        "Nur die Kamera der Szene. Am schnellsten, ohne Licht von außerhalb des Bildes"
    ),
    "Automatic": "Automatisch",
    "Place further views in each shot where they capture most missing light": (
        "In jeder Einstellung weitere Ansichten dort platzieren, wo sie das meiste fehlende Licht erfassen"
    ),
    "Manual": "Manuell",
    "The cameras in the list": "Die Kameras in der Liste",
    "Views at Most": "Höchstzahl der Ansichten",
    "Maximum number of automatic views. Fewer are placed, at less cost, if another one would capture little new "
    "light": (
        "Höchstzahl automatischer Ansichten. Es werden weniger platziert, was Zeit spart, wenn eine weitere kaum neues"
        " Licht erfassen würde"
    ),
    "Camera": "Kamera",
    "Cameras": "Kameras",
    "The cameras that are used as manual views": "Die Kameras, die als manuelle Ansichten verwendet werden",
    "A camera that sees surfaces which light the image. The position of a lamp is a good one": (
        "Eine Kamera, die Flächen sieht, welche das Bild beleuchten. Die Position einer Lampe eignet sich gut"
    ),
    "Keep Views as Cameras": "Ansichten als Kameras behalten",
    "Create a camera for each automatic view of the last render and set Views to Manual with these cameras, so that"
    " you can adjust them. From then on all frames have the same views, on every computer of a render farm": (
        "Für jede automatische Ansicht des letzten Renderings eine Kamera anlegen und Ansichten mit diesen Kameras auf"
        " Manuell setzen, um sie anpassen zu können. Danach haben alle Einzelbilder dieselben Ansichten, auf jedem "
        "Rechner einer Renderfarm"
    ),
    "Add View": "Ansicht hinzufügen",
    "Add the selected cameras to the list of views, or an empty slot if no camera is selected": (
        "Die ausgewählten Kameras zur Liste der Ansichten hinzufügen, oder einen leeren Eintrag, wenn keine ausgewählt"
        " ist"
    ),
    "Remove View": "Ansicht entfernen",
    "Remove the active camera from the list of views. It stays in the scene": (
        "Die aktive Kamera aus der Liste der Ansichten entfernen. Sie bleibt in der Szene"
    ),
    "Seen by the Camera": "Von der Kamera gesehen",
    "Seen with {} Views": "Mit {} Ansichten gesehen",
    "Placing": "Platzierung",
    "There can be at most {} views. Remove one first": "Es sind höchstens {} Ansichten möglich. Zuerst eine entfernen",
    "No views have been placed in this scene yet. Set Views to Automatic and press F12": (
        "In dieser Szene wurden noch keine Ansichten platziert. Ansichten auf Automatisch setzen und F12 drücken"
    ),
    # Panel and menu
    "Indirect Light Presets": "Voreinstellungen für indirektes Licht",
    "Sampling": "Abtastung",
    "Last Render": "Letztes Rendering",
    "Why the last render has no indirect light; empty if it succeeded": (
        "Warum das letzte Rendering kein indirektes Licht hat; leer, wenn es gelungen ist"
    ),
    "Total time": "Gesamtzeit",
    "Place views": "Ansichten platzieren",
    "EEVEE, views": "EEVEE, Ansichten",
    "Write passes": "Passes schreiben",
    "Saving passes": "Passes werden gespeichert",
    "Gather on the GPU": "Licht auf der GPU berechnen",
    "Upload": "Hochladen",
    "Pyramid": "Pyramide",
    "Gather": "Licht berechnen",
    "Upsample": "Hochskalieren",
    "Glossy": "Glanz",
    "Read back": "Zurücklesen",
    "Hand back": "Übergeben",
    "GPU memory": "GPU-Speicher",
    "Passes file": "Datei der Passes",
    "Copy Settings": "Einstellungen kopieren",
    "To All Scenes": "In alle Szenen",
    "Reset Settings": "Einstellungen zurücksetzen",
    "Indirect Light {} / {}": "Indirekte Beleuchtung {} / {}",
    # Operators
    "Fix Scene for Indirect Light": "Szene für indirektes Licht korrigieren",
    "Repair Indirect Light": "Indirektes Licht reparieren",
    "Restore the helper scene, passes and compositor nodes that Indirect Light needs": (
        "Hilfsszene, Passes und Compositor-Nodes wiederherstellen, die für indirektes Licht nötig sind"
    ),
    "Copy Indirect Light Settings": "Einstellungen des indirekten Lichts kopieren",
    "Copy the Indirect Light settings of this scene to other scenes, with their values in the current frame. "
    "Keyframes and drivers are not copied, nor cameras in the list of views that are not in the other scene": (
        "Die Einstellungen des indirekten Lichts dieser Szene in andere Szenen kopieren, mit den Werten im aktuellen "
        "Einzelbild. Nicht kopiert werden Schlüsselbilder und Treiber sowie Kameras aus der Liste der Ansichten, die "
        "die andere Szene nicht enthält"
    ),
    "Scene": "Szene",
    "Scene to copy the settings to; all other scenes if empty": (
        "Szene, in die die Einstellungen kopiert werden; alle anderen Szenen, wenn leer"
    ),
    "Also Enable": "Auch einschalten",
    "Enable Indirect Light in those scenes as well": "Indirekte Beleuchtung in diesen Szenen ebenfalls einschalten",
    "Settings copied to {}": "Einstellungen kopiert nach {}",
    'There is no other scene "{}" that can be edited': "Es gibt keine andere Szene „{}“, die bearbeitet werden kann",
    "The file has no other scene that can be edited": (
        "Die Datei enthält keine andere Szene, die bearbeitet werden kann"
    ),
    "The scene is linked from another file and cannot be edited here": (
        "Die Szene ist aus einer anderen Datei verknüpft und kann hier nicht bearbeitet werden"
    ),
    "Reset Indirect Light Settings": "Einstellungen des indirekten Lichts zurücksetzen",
    "Set all settings in this panel to their defaults, except the checkbox in its header. The list of cameras is "
    "kept, and so are keyframes and drivers": (
        "Alle Einstellungen in diesem Panel auf die Standardwerte setzen, außer dem Häkchen in der Kopfzeile. Die "
        "Liste der Kameras sowie Schlüsselbilder und Treiber bleiben erhalten"
    ),
    '{} in scene "{}" has keyframes or a driver, which override it in every frame': (
        "{} in der Szene „{}“ hat Schlüsselbilder oder einen Treiber, die den Wert in jedem Einzelbild überschreiben"
    ),
    "Indirect Light Help": "Hilfe zum indirekten Licht",
    "Open the help page of this version in the web browser. No internet connection is needed": (
        "Die Hilfeseite dieser Version im Webbrowser öffnen (englisch). Eine Internetverbindung ist nicht nötig"
    ),
    "Help page: {}": "Hilfeseite: {}",
    "Load Indirect Light Preset": "Voreinstellung für indirektes Licht laden",
    "Load the settings of this preset. Strength, Viewport and the seed are kept": (
        "Die Einstellungen dieser Voreinstellung laden. Stärke, Ansichtsfenster und Startwert bleiben erhalten"
    ),
    "For lighting a shot: up to 4 views, 3 bounces. In the sample scenes the indirect light has an error of 14 %; "
    "EEVEE's ray tracing has 61 % at its best. Without a graphics card a frame takes 2.5 times as long as EEVEE "
    "alone with 16 samples": (
        "Zum Einrichten der Beleuchtung: bis zu 4 Ansichten, 3 Reflexionen. In den Beispielszenen hat das indirekte "
        "Licht einen Fehler von 14 %, EEVEEs Raytracing im besten Fall 61 %. Ohne Grafikkarte dauert ein Bild 2,5-mal "
        "so lange wie mit EEVEE allein bei 16 Samples"
    ),
    "The published method: one bounce between surfaces that the camera sees, without occlusion or further views. In"
    " the sample scenes the indirect light has an error of 60 %; a frame takes little longer than with EEVEE alone": (
        "Das veröffentlichte Verfahren: eine Reflexion zwischen Flächen im Bild der Kamera, ohne Verdeckung und ohne "
        "weitere Ansichten. In den Beispielszenen hat das indirekte Licht einen Fehler von 60 %; ein Bild dauert kaum "
        "länger als mit EEVEE allein"
    ),
    "For final images: up to 7 views, 4 bounces. In the sample scenes the indirect light has an error of 10 %; "
    "EEVEE's ray tracing has 61 % at its best. Without a graphics card a frame takes 3.2 times as long as EEVEE "
    "alone with 16 samples": (
        "Für fertige Bilder: bis zu 7 Ansichten, 4 Reflexionen. In den Beispielszenen hat das indirekte Licht einen "
        "Fehler von 10 %, EEVEEs Raytracing im besten Fall 61 %. Ohne Grafikkarte dauert ein Bild 3,2-mal so lange wie"
        " mit EEVEE allein bei 16 Samples"
    ),
    "Ground truth for comparing presets: up to 9 views, 8 bounces, four times the draws, full resolution": (
        "Referenz zum Vergleich der Voreinstellungen: bis zu 9 Ansichten, 8 Reflexionen, viermal so viele Ziehungen, "
        "volle Auflösung"
    ),
    '"{}" is not in a folder of Indirect Light presets and was not run. Choose a preset from the list in the panel': (
        "„{}“ liegt in keinem Ordner für Voreinstellungen des indirekten Lichts und wurde nicht ausgeführt. Eine "
        "Voreinstellung aus der Liste im Panel wählen"
    ),
    "The preset has an error and no setting was changed: {}": (
        "Die Voreinstellung enthält einen Fehler, und keine Einstellung wurde geändert: {}"
    ),
    "Add Indirect Light Preset": "Voreinstellung für indirektes Licht hinzufügen",
    "Save the Indirect Light settings as a preset, or remove a preset": (
        "Die Einstellungen des indirekten Lichts als Voreinstellung speichern oder eine Voreinstellung entfernen"
    ),
    'There is no preset "{}"': "Es gibt keine Voreinstellung „{}“",
    "The preset could not be saved ({}). Free some space on the disk of Blender's user folder, or make the folder "
    "writable": (
        "Die Voreinstellung konnte nicht gespeichert werden ({}). Auf dem Datenträger von Blenders Benutzerordner "
        "Platz schaffen oder Schreibrechte für den Ordner geben"
    ),
    "Update Indirect Light": "Indirektes Licht aktualisieren",
    "Compute the indirect light of the last render again with the current settings, and composite the image. EEVEE "
    "does not render again, so changes of the scene since then are not included": (
        "Das indirekte Licht des letzten Renderings mit den aktuellen Einstellungen neu berechnen und das Bild "
        "zusammensetzen. EEVEE rendert nicht erneut; spätere Änderungen der Szene sind nicht enthalten"
    ),
    "Free Kept Passes": "Behaltene Passes freigeben",
    "Delete the passes of the last render from the temporary folder, where they are kept until Blender quits. "
    "Updating the light then requires a new render": (
        "Die Passes des letzten Renderings aus dem Ordner für temporäre Dateien löschen, wo sie bis zum Beenden von "
        "Blender bleiben. Um das Licht zu aktualisieren, muss danach neu gerendert werden"
    ),
    "Enable Indirect Light first": "Zuerst Indirekte Beleuchtung einschalten",
    "A render is in progress. Wait until it ends": "Es wird gerade gerendert. Das Ende abwarten",
    "There are no passes of a render of this scene. Press F12 first": (
        "Es gibt keine Passes eines Renderings dieser Szene. Zuerst F12 drücken"
    ),
    "The passes of the last render were deleted from the temporary folder. Press F12": (
        "Die Passes des letzten Renderings wurden aus dem Ordner für temporäre Dateien gelöscht. F12 drücken"
    ),
    "Indirect Light needs EEVEE. Set Render Engine to EEVEE": (
        "Indirekte Beleuchtung benötigt EEVEE. Die Renderengine auf EEVEE setzen"
    ),
    "The resolution or the render region has changed since the last render. Press F12": (
        "Auflösung oder Renderbereich haben sich seit dem letzten Rendering geändert. F12 drücken"
    ),
    "View layers were added or renamed since the last render. Press F12": (
        "Seit dem letzten Rendering wurden Ansichtsebenen hinzugefügt oder umbenannt. F12 drücken"
    ),
    # Fixes
    "Repair": "Reparieren",
    "Set Render Engine to EEVEE": "Renderengine auf EEVEE setzen",
    "Render this scene with EEVEE. The settings of the other engine are kept": (
        "Diese Szene mit EEVEE rendern. Die Einstellungen der anderen Engine bleiben erhalten"
    ),
    "Use a Camera of the Scene": "Eine Kamera der Szene verwenden",
    "Make the first camera in the scene its active camera": "Die erste Kamera der Szene zur aktiven Kamera machen",
    "Set Lens Type to Perspective": "Lens Type auf Perspektive setzen",
    "Make it a perspective camera. Its panorama settings are kept": (
        "Eine perspektivische Kamera daraus machen. Ihre Panorama-Einstellungen bleiben erhalten"
    ),
    "Render This View Layer": "Diese Ansichtsebene rendern",
    "Enable Use for Rendering for the active view layer": (
        "Benutze zum rendern für die aktive Ansichtsebene einschalten"
    ),
    "Turn Off Stereoscopy": "Stereoskopie ausschalten",
    "Render a single view, that of the active camera": "Nur eine Ansicht rendern, die der aktiven Kamera",
    "Render All View Layers": "Alle Ansichtsebenen rendern",
    "Disable Render Single Layer. All view layers that are used for rendering are then rendered": (
        "Eine Ebene rendern ausschalten. Danach werden alle Ansichtsebenen gerendert, die zum Rendern verwendet werden"
    ),
    "Render the Scene": "Die Szene rendern",
    "Disable Sequencer in Output properties > Post Processing. The strips are kept": (
        "Sequenzer in den Ausgabe-Eigenschaften > Nachbearbeitung ausschalten. Die Streifen bleiben erhalten"
    ),
    "Turn Off Ray Tracing": "Raytracing ausschalten",
    "Disable EEVEE's ray tracing, so that indirect light is not added twice. Its reflections and refractions are "
    "disabled as well": (
        "EEVEEs Raytracing ausschalten, damit indirektes Licht nicht doppelt hinzukommt. Seine Spiegelungen und "
        "Brechungen werden ebenfalls ausgeschaltet"
    ),
    "Disable Volumes in Renders": "Volumen in Renderings ausschalten",
    "Disable the light probe volumes in renders. Their baked data is kept": (
        "Die Lichtsonden-Volumen in Renderings ausschalten. Ihre gebackenen Daten bleiben erhalten"
    ),
    "Show That Scene": "Jene Szene zeigen",
    "Show the scene that this helper scene belongs to": "Die Szene zeigen, zu der diese Hilfsszene gehört",
    "Add Render Layers Node": "Render-Ebenen-Node hinzufügen",
    "Add a Render Layers node of this scene outside of node groups, so that Blender renders the scene": (
        "Einen Render-Ebenen-Node dieser Szene außerhalb von Node-Gruppen hinzufügen, damit Blender die Szene rendert"
    ),
    # What is wrong with a scene
    "This helper scene's owner was deleted, or it is a copy of a helper scene. You can delete it": (
        "Die Szene, zu der diese Hilfsszene gehört, wurde gelöscht, oder sie ist die Kopie einer Hilfsszene. Sie kann "
        "gelöscht werden"
    ),
    'This is a helper scene of "{}" and cannot be lit itself. Render that scene': (
        "Dies ist eine Hilfsszene von „{}“ und kann selbst nicht beleuchtet werden. Jene Szene rendern"
    ),
    "Indirect Light was enabled, or a setting that changes its nodes was changed, during a render. It takes effect "
    "in the next render. Scripts should change settings before the render begins": (
        "Während eines Renderings wurde Indirekte Beleuchtung eingeschaltet oder eine Einstellung geändert, die ihre "
        "Nodes ändert. Das wirkt ab dem nächsten Rendering. Skripte sollten Einstellungen vor Beginn des Renderings "
        "ändern"
    ),
    "Indirect Light was enabled during a render. It takes effect in the next render": (
        "Indirekte Beleuchtung wurde während eines Renderings eingeschaltet. Sie wirkt ab dem nächsten Rendering"
    ),
    "Indirect Light was disabled during a render. Frames from {} on have no indirect light": (
        "Indirekte Beleuchtung wurde während eines Renderings ausgeschaltet. Ab Einzelbild {} haben die Bilder kein "
        "indirektes Licht"
    ),
    "Indirect Light needs EEVEE, but the render engine is {}. Set Render Engine to EEVEE, or disable Indirect Light": (
        "Indirekte Beleuchtung benötigt EEVEE, aber die Renderengine ist {}. Die Renderengine auf EEVEE setzen oder "
        "Indirekte Beleuchtung ausschalten"
    ),
    "The scene has no active camera. Choose one in the Scene properties": (
        "Die Szene hat keine aktive Kamera. In den Szenen-Eigenschaften eine wählen"
    ),
    "The scene has no camera. Add one (Add > Camera) and make it the active camera": (
        "Die Szene hat keine Kamera. Eine hinzufügen (Hinzufügen > Kamera) und zur aktiven Kamera machen"
    ),
    'The scene\'s active camera "{}" is not a camera object. Choose a camera in the Scene properties': (
        "Die aktive Kamera „{}“ der Szene ist kein Kameraobjekt. In den Szenen-Eigenschaften eine Kamera wählen"
    ),
    'The camera "{}" is panoramic. Set its Lens Type to Perspective or Orthographic': (
        "Die Kamera „{}“ ist panoramisch. Ihren Lens Type auf Perspektive oder Orthografisch setzen"
    ),
    "No view layer is rendered. Enable Use for Rendering in the View Layer properties": (
        "Keine Ansichtsebene wird gerendert. Benutze zum rendern in den Eigenschaften der Ansichtsebene einschalten"
    ),
    "Stereo and multi-view renders are not supported. Disable Stereoscopy in the Output properties": (
        "Renderings in Stereo oder mit mehreren Ansichten werden nicht unterstützt. Stereoskopie in den "
        "Ausgabe-Eigenschaften ausschalten"
    ),
    "With Render Single Layer, Blender does not render the helper scene that computes the light. Disable it in the "
    "View Layer properties": (
        "Mit Eine Ebene rendern rendert Blender die Hilfsszene nicht, die das Licht berechnet. Es in den Eigenschaften"
        " der Ansichtsebene ausschalten"
    ),
    "The strips of the Video Sequencer are rendered instead of the scene. Disable Sequencer in Output properties > "
    "Post Processing, or remove the strips": (
        "Statt der Szene werden die Streifen des Video-Sequenzers gerendert. Sequenzer in den Ausgabe-Eigenschaften > "
        "Nachbearbeitung ausschalten oder die Streifen entfernen"
    ),
    "EEVEE's ray tracing already adds indirect light. Disable either ray tracing or Indirect Light": (
        "EEVEEs Raytracing fügt bereits indirektes Licht hinzu. Entweder Raytracing oder Indirekte Beleuchtung "
        "ausschalten"
    ),
    "Light probe volumes add indirect light of their own once they are baked. Disable them in renders, or delete "
    "their baked data": (
        "Lichtsonden-Volumen fügen selbst indirektes Licht hinzu, sobald sie gebacken sind. Sie in Renderings "
        "ausschalten oder ihre gebackenen Daten löschen"
    ),
    "Light probe spheres and planes already reflect the scene, so Glossy Light is left out. Disable them in renders"
    " to use it": (
        "Lichtsonden (Kugeln und Ebenen) spiegeln die Szene bereits, daher entfällt Glänzendes Licht. Sie in "
        "Renderings ausschalten, um es zu verwenden"
    ),
    "These settings were saved by Afterlight {}, but this is {}. Settings that this version does not know are kept "
    "in the file and have no effect": (
        "Diese Einstellungen wurden mit Afterlight {} gespeichert, dies ist aber {}. Einstellungen, die diese Version "
        "nicht kennt, bleiben in der Datei und haben keine Wirkung"
    ),
    # What is wrong with the compositor
    "Afterlight's helper scene was deleted or changed. Press Repair": (
        "Die Hilfsszene von Afterlight wurde gelöscht oder geändert. Reparieren drücken"
    ),
    "Compositing is disabled, so no light can be added to the image. Press Repair": (
        "Compositing ist ausgeschaltet, daher kann dem Bild kein Licht hinzugefügt werden. Reparieren drücken"
    ),
    "View layers were added, removed or renamed since Indirect Light was enabled. Press Repair": (
        "Seit Indirekte Beleuchtung eingeschaltet wurde, wurden Ansichtsebenen hinzugefügt, entfernt oder umbenannt. "
        "Reparieren drücken"
    ),
    'The compositor has no Render Layers node of "{}", so there is no image to add light to. Add one and link its '
    "Image": (
        "Der Compositor hat keinen Render-Ebenen-Node von „{}“, also kein Bild, dem Licht hinzugefügt werden könnte. "
        "Einen hinzufügen und sein Bild verbinden"
    ),
    'All Render Layers nodes of "{}" are muted, so there is no image to add light to. Unmute one': (
        "Alle Render-Ebenen-Nodes von „{}“ sind stummgeschaltet, daher gibt es kein Bild, dem Licht hinzugefügt werden"
        " könnte. Die Stummschaltung eines davon aufheben"
    ),
    "All Render Layers nodes of this scene are inside node groups, so Blender does not render the scene. Add one "
    "outside of the groups. It does not have to be linked": (
        "Alle Render-Ebenen-Nodes dieser Szene liegen in Node-Gruppen, daher rendert Blender die Szene nicht. "
        "Außerhalb der Gruppen einen hinzufügen. Er muss nicht verbunden sein"
    ),
    "The node that adds the light to {} was deleted, and with it the links of the image. Link the Image of its "
    "Render Layers node again": (
        "Der Node, der {} das Licht hinzufügt, wurde gelöscht und mit ihm die Verbindungen des Bildes. Das Bild des "
        "zugehörigen Render-Ebenen-Nodes neu verbinden"
    ),
    "The image is no longer linked to the node that adds the light to it. Press Repair": (
        "Das Bild ist nicht mehr mit dem Node verbunden, der ihm das Licht hinzufügt. Reparieren drücken"
    ),
    "The compositor uses {} without the indirect light, because a node of Afterlight was deleted or a Render Layers"
    " node was added. Press Repair": (
        "Der Compositor verwendet {} ohne das indirekte Licht, weil ein Node von Afterlight gelöscht oder ein "
        "Render-Ebenen-Node hinzugefügt wurde. Reparieren drücken"
    ),
    "Afterlight's Render Layers node was deleted from the compositor. Press Repair": (
        "Der Render-Ebenen-Node von Afterlight wurde aus dem Compositor gelöscht. Reparieren drücken"
    ),
    'The compositor does not use the Image of any Render Layers node of "{}", so there is no image to add light to.'
    " Link the Image of one, or the output Indirect of Afterlight's own Render Layers node": (
        "Der Compositor verwendet das Bild keines Render-Ebenen-Nodes von „{}“, daher gibt es kein Bild, dem Licht "
        "hinzugefügt werden könnte. Das Bild eines solchen Nodes verbinden oder den Ausgang Indirect von Afterlights "
        "eigenem Render-Ebenen-Node"
    ),
    "The indirect light is no longer linked to the node that adds it. Press Repair": (
        "Das indirekte Licht ist nicht mehr mit dem Node verbunden, der es hinzufügt. Reparieren drücken"
    ),
    "A helper scene for the views was deleted, or its node in the compositor. Press Repair": (
        "Eine Hilfsszene für die Ansichten oder ihr Node im Compositor wurde gelöscht. Reparieren drücken"
    ),
    "The glossy light is no longer linked to the node that adds it. Press Repair": (
        "Das glänzende Licht ist nicht mehr mit dem Node verbunden, der es hinzufügt. Reparieren drücken"
    ),
    "The Denoise node of the indirect light was deleted. Press Repair": (
        "Der Entrauschen-Node des indirekten Lichts wurde gelöscht. Reparieren drücken"
    ),
    "The node that draws the Freestyle lines over the light was deleted. Press Repair": (
        "Der Node, der die Freestyle-Linien über das Licht legt, wurde gelöscht. Reparieren drücken"
    ),
    "A pass that Afterlight needs was disabled. Press Repair": (
        "Ein Pass, den Afterlight benötigt, wurde ausgeschaltet. Reparieren drücken"
    ),
    # What is wrong with views
    "A view in the list has no camera. Choose one, or remove the entry": (
        "Eine Ansicht in der Liste hat keine Kamera. Eine wählen oder den Eintrag entfernen"
    ),
    'The view "{}" is not a camera object and was left out. Choose a camera instead': (
        "Die Ansicht „{}“ ist kein Kameraobjekt und wurde ausgelassen. Stattdessen eine Kamera wählen"
    ),
    'The view "{}" is panoramic and was left out. Set its Lens Type to Perspective or Orthographic': (
        "Die Ansicht „{}“ ist panoramisch und wurde ausgelassen. Ihren Lens Type auf Perspektive oder Orthografisch "
        "setzen"
    ),
    'The view "{}" sees no surface that lights the image and was left out. It may be inside a wall or face away. '
    "Move it, or remove it from the list": (
        "Die Ansicht „{}“ sieht keine Fläche, die das Bild beleuchtet, und wurde ausgelassen. Vielleicht steckt sie in"
        " einer Wand oder ist abgewandt. Sie versetzen oder aus der Liste entfernen"
    ),
    "A view could not be used: {}": "Eine Ansicht konnte nicht verwendet werden: {}",
    "No views were placed, because no surface adds light to what the camera sees": (
        "Es wurden keine Ansichten platziert, weil keine Fläche das Bild der Kamera zusätzlich beleuchtet"
    ),
    "No views were placed, because no free position shows more than the camera does": (
        "Es wurden keine Ansichten platziert, weil von keiner freien Position aus mehr zu sehen ist als von der Kamera"
    ),
    "The last render had {} further views, but the settings now have {}. Press F12 to render all of them": (
        "Das letzte Rendering hatte {} weitere Ansichten, in den Einstellungen sind es jetzt {}. F12 drücken, um alle "
        "zu rendern"
    ),
    # What can go wrong in a render
    "Afterlight (used by its helper scenes)": "Afterlight (für seine Hilfsszenen)",
    "Afterlight's views (used by its helper scenes)": "Ansichten von Afterlight (für seine Hilfsszenen)",
    "Afterlight's last render (used to update its light)": (
        "Letztes Rendering von Afterlight (zum Aktualisieren des Lichts)"
    ),
    "Afterlight: the image has no indirect light": "Afterlight: Das Bild hat kein indirektes Licht",
    "Afterlight: the viewport has no indirect light": "Afterlight: Das Ansichtsfenster hat kein indirektes Licht",
    "This render engine is only for Afterlight's helper scenes. Set Render Engine to EEVEE and enable Indirect Light": (
        "Diese Renderengine ist nur für die Hilfsszenen von Afterlight. Die Renderengine auf EEVEE setzen und "
        "Indirekte Beleuchtung einschalten"
    ),
    "Internal error in Afterlight ({}). Please report it with the details in the terminal": (
        "Interner Fehler in Afterlight ({}). Bitte mit den Einzelheiten aus dem Terminal melden"
    ),
    "Afterlight: {} pixels of {} in {} are NaN or infinite and emit no indirect light. Look for a material that "
    "divides by zero, or a light of infinite strength": (
        "Afterlight: {} Pixel von {} in {} sind NaN oder unendlich und senden kein indirektes Licht aus. Nach einem "
        "Material suchen, das durch null teilt, oder nach einer Lichtquelle mit unendlicher Stärke"
    ),
    "The last render has no passes for Glossy Light. Press F12 to render them": (
        "Das letzte Rendering hat keine Passes für Glänzendes Licht. F12 drücken, um sie zu rendern"
    ),
    'There is no render of "{}". Render that scene instead of its helper scene': (
        "Es gibt kein Rendering von „{}“. Jene Szene statt ihrer Hilfsszene rendern"
    ),
    "The passes could not be written to {} ({}). Free some space there, or choose another folder in Preferences > "
    "File Paths > Temporary Files and restart Blender": (
        "Die Passes konnten nicht nach {} geschrieben werden ({}). Dort Platz schaffen oder in Benutzereinstellungen >"
        " Dateipfade > Temporäre Dateien einen anderen Ordner wählen und Blender neu starten"
    ),
    "The passes could not be read back from {} ({}). The disk of the temporary folder may be full: free some space "
    "there": (
        "Die Passes konnten nicht aus {} zurückgelesen werden ({}). Der Datenträger des Ordners für temporäre Dateien "
        "ist vielleicht voll: dort Platz schaffen"
    ),
    "The render has no pass {}. Press Repair in the Indirect Light panel, then render again": (
        "Dem Rendering fehlt der Pass {}. Im Panel Indirekte Beleuchtung auf Reparieren drücken und neu rendern"
    ),
    "The OpenEXR module can't be imported ({}). It comes with the extension: remove Afterlight in Preferences > Get"
    " Extensions and install it again from its zip": (
        "Das Modul OpenEXR kann nicht geladen werden ({}). Es gehört zur Erweiterung: Afterlight in "
        "Benutzereinstellungen > Get Extensions entfernen und aus seiner Zip-Datei neu installieren"
    ),
    "The frame needs a texture of {} x {}, but this GPU's largest is {} x {}. Lower the render resolution": (
        "Das Bild benötigt eine Textur von {} x {}, die größte dieser GPU ist aber {} x {}. Die Renderauflösung senken"
    ),
    "Blender has no GPU here. In background mode it needs a graphics driver; on a machine without a display, "
    "install Mesa's software driver": (
        "Blender hat hier keine GPU. Im Hintergrundmodus benötigt es einen Grafiktreiber; auf einem Rechner ohne "
        "Bildschirm Mesas Softwaretreiber installieren"
    ),
    "The GPU has no memory for a texture of {} x {}. Use a coarser start resolution, or lower the render resolution": (
        "Die GPU hat keinen Speicher für eine Textur von {} x {}. Eine gröbere Startauflösung verwenden oder die "
        "Renderauflösung senken"
    ),
    "The GPU driver cannot compile the shader '{}'. Update the graphics driver, or try Blender's other GPU backend "
    "in the preferences": (
        "Der Grafiktreiber kann den Shader „{}“ nicht übersetzen. Den Treiber aktualisieren oder in den "
        "Benutzereinstellungen Blenders anderes GPU-Backend versuchen"
    ),
}
