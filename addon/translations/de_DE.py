# SPDX-License-Identifier: GPL-3.0-or-later
"""German."""

TEXTS = {
    # Settings
    "Glossy Light": "Glänzendes Licht",
    "Let glossy surfaces reflect the bounced light, and the surfaces that the views show. Takes about half as much time "
    "again as the gather without it, and three more passes of EEVEE": "Glänzende Flächen das indirekte Licht und die Flächen spiegeln lassen, die die Ansichten zeigen. Dauert etwa halb so "
    "lange wie das Sammeln ohne es und braucht drei weitere Passes von EEVEE",
    "The glossy light is no longer linked to the node that adds it": "Das glänzende Licht ist nicht mehr mit dem Node verbunden, der es addiert",
    "Light probe spheres and planes hold reflections of the scene already, so the glossy light is left out. Disable them in "
    "renders to have it": "Lichtsonden (Kugeln und Ebenen) enthalten bereits Spiegelungen der Szene, daher bleibt das glänzende Licht weg. Im Rendering "
    "ausblenden, um es zu haben",
    "The last render has no passes for the glossy light. Press F12 to have it": "Das letzte Rendern hat keine Passes für das glänzende Licht. F12 drücken, um es zu haben",
    "Glossy": "Glanz",
    "Indirect Light": "Indirekte Beleuchtung",
    "Add one bounce of indirect light to EEVEE's renders, gathered from the passes of the finished frame. To fade it "
    "in an animation, put keyframes on Strength": "EEVEEs Bildern indirektes Licht nach einer Reflexion hinzufügen, gesammelt aus den Passes des fertigen "
    "Bildes. Zum Ein- und Ausblenden in einer Animation Schlüsselbilder auf die Stärke setzen",
    "Viewport": "Ansichtsfenster",
    "Show the indirect light in viewports with rendered shading, while you work. Each change draws EEVEE's passes again, five small "
    "pictures; at rest the light is gathered as a render does until its noise is gone, and then nothing more is drawn. Glossy light "
    "is left to renders": "Das indirekte Licht beim Arbeiten in gerenderten Ansichtsfenstern zeigen. Bei jeder Änderung werden EEVEEs Passes neu gezeichnet, "
    "fünf kleine Bilder; in Ruhe wird das Licht wie beim Rendern gesammelt, bis das Rauschen weg ist, und dann nichts mehr gezeichnet. "
    "Glänzendes Licht bleibt dem Rendern überlassen",
    "Afterlight: the viewport has no indirect light": "Afterlight: Das Ansichtsfenster hat kein indirektes Licht",
    "Indirect Light {} / {}": "Indirekte Beleuchtung {} / {}",
    "Last Render": "Letztes Rendern",
    "What kept the last render of this scene from being lit, empty where nothing did": "Was das letzte Rendern dieser Szene ohne Licht ließ, sonst leer",
    "Strength": "Stärke",
    "Scales the indirect light in the picture. 1 is what the light really does; it is a factor on linear light, so "
    "exposure and view transform do not change its meaning. Costs nothing": "Faktor auf das indirekte Licht im Bild. 1 entspricht dem wirklichen Licht; er gilt für lineares Licht, "
    "Belichtung und Ansichtstransformation ändern also nichts an seiner Bedeutung. Kostet keine Zeit",
    "Start Resolution": "Startauflösung",
    "Finest resolution at which light is gathered. Each step up costs four times as much and sharpens the light near "
    "edges and contacts; it does not change how bright the light is": "Feinste Auflösung, in der Licht gesammelt wird. Jede Stufe kostet das Vierfache und schärft das Licht an "
    "Kanten und Berührungsstellen; die Helligkeit ändert sich nicht",
    "Quarter": "Viertel",
    "One texel for 4 x 4 pixels: the fastest, softest near contacts": "Ein Texel für 4 x 4 Pixel: am schnellsten, am weichsten an Berührungsstellen",
    "Half": "Halb",
    "One texel for 2 x 2 pixels: four times the cost of Quarter": "Ein Texel für 2 x 2 Pixel: viermal so teuer wie Viertel",
    "Full": "Voll",
    "One texel a pixel: sixteen times the cost of Quarter": "Ein Texel je Pixel: sechzehnmal so teuer wie Viertel",
    "Samples": "Abtastwerte",
    "Random samples a texel takes at the finest level, twice as many at each coarser one, where noise shows most. "
    "Time grows in proportion, noise falls with the square root. Where the radius holds fewer texels than that, each "
    "is visited once and there is no noise at all": "Zufällige Abtastwerte je Texel auf der feinsten Ebene, doppelt so viele auf jeder gröberen, wo Rauschen am "
    "meisten auffällt. Die Zeit wächst im gleichen Verhältnis, das Rauschen sinkt mit der Wurzel. Umfasst der "
    "Radius weniger Texel, so wird jedes einmal besucht, und es rauscht gar nicht",
    "Radius": "Radius",
    "Radius of the disk that is sampled at each level, in texels of that level. Larger is closer to the exact sum "
    "over all pixels, but the same samples are spread over more texels and the light gets noisier. Time depends on "
    "the samples far more than on this": "Radius der Scheibe, die auf jeder Ebene abgetastet wird, in Texeln dieser Ebene. Größer kommt der genauen "
    "Summe über alle Pixel näher, doch dieselben Abtastwerte verteilen sich auf mehr Texel, und das Licht rauscht "
    "stärker. Die Zeit hängt weit mehr von den Abtastwerten ab",
    "Seed": "Startwert",
    "Pattern of the random samples. The same seed gives the same picture, bit for bit. Costs nothing. Without effect "
    "where there are so many samples that there is no noise": "Muster der zufälligen Abtastwerte. Derselbe Startwert ergibt dasselbe Bild, Bit für Bit. Kostet keine Zeit. "
    "Ohne Wirkung, wo es bei so vielen Abtastwerten nicht rauscht",
    "Animate Seed": "Startwert animieren",
    "Use another pattern in every frame, so that the noise does not stick to the picture as the camera moves. Costs "
    "nothing": "In jedem Einzelbild ein anderes Muster nehmen, damit das Rauschen bei bewegter Kamera nicht am Bild klebt. "
    "Kostet keine Zeit",
    "Average Frames": "Einzelbilder mitteln",
    "In animations, average the light of each frame with that of the frames before, wherever they show the same surface. "
    "Noise falls to a third and costs no time, but for a render's first frame, which takes nine gathers instead of one. Light "
    "that changes arrives within a few frames. Single renders are as they are without": "In Animationen das Licht jedes Einzelbildes mit dem der vorigen mitteln, wo sie dieselbe Fläche zeigen. Das Rauschen "
    "sinkt auf ein Drittel und kostet keine Zeit, bis auf das erste Bild eines Renderns, für das neunmal gesammelt wird statt "
    "einmal. Licht, das sich ändert, kommt in wenigen Bildern an. Einzelne Bilder bleiben, wie sie ohne sind",
    "Accumulate": "Aufsummieren",
    "Gathers that each picture is the mean of. Time grows in proportion, noise falls with the square root": "So viele Male wird für jedes Bild gesammelt und gemittelt. Die Zeit wächst im gleichen Verhältnis, das Rauschen sinkt "
    "mit der Wurzel",
    "Denoise": "Entrauschen",
    "How noise is taken out of the light. Costs little beside the gather": "Wie das Rauschen aus dem Licht kommt. Kostet wenig neben dem Sammeln",
    "None": "Nicht",
    "Leave it as it was drawn": "Es lassen, wie es gezogen wurde",
    "Smooth": "Glätten",
    "Average neighbouring texels along surfaces": "Benachbarte Texel auf derselben Fläche mitteln",
    "Denoise Node": "Entrauschen-Node",
    "Blender's Denoise node on the light alone, in the compositor. A tenth closer than Smooth where Start Resolution is Full; it "
    "leaves the noise of coarser ones": "Blenders Entrauschen-Node auf das Licht allein, im Compositor. Ein Zehntel näher als Glätten, wo die Startauflösung Voll "
    "ist; das Rauschen gröberer lässt er stehen",
    "The Denoise node of the indirect light was deleted": "Der Entrauschen-Node des indirekten Lichts wurde gelöscht",
    "The node that lays the Freestyle lines over the light was deleted": "Der Node, der die Freestyle-Linien über das Licht legt, wurde gelöscht",
    "Shadow World": "Welt abschatten",
    "Take the light of the world away where surfaces stand before it: EEVEE lets it shine through walls. For worlds of one "
    "colour or of an environment picture; needs Visibility, and costs nothing": "Das Licht der Welt wegnehmen, wo Flächen davor stehen: EEVEE lässt es durch Wände scheinen. Für einfarbige Welten und "
    "solche aus einem Umgebungsbild; braucht Sichtbarkeit und kostet keine Zeit",
    # Panel and menu
    "Indirect Light Presets": "Voreinstellungen für indirektes Licht",
    "Sampling": "Abtastung",
    "Total time": "Zeit gesamt",
    "Place views": "Ansichten aufstellen",
    "EEVEE, views": "EEVEE, Ansichten",
    "Write passes": "Passes schreiben",
    "Saving passes": "Passes werden gespeichert",
    "Gather on the GPU": "Sammeln auf der GPU",
    "Upload": "Hochladen",
    "Pyramid": "Pyramide",
    "Gather": "Sammeln",
    "Upsample": "Hochrechnen",
    "Read back": "Zurücklesen",
    "Hand back": "Übergeben",
    "GPU memory": "GPU-Speicher",
    "Passes file": "Datei der Passes",
    "Copy Settings": "Einstellungen kopieren",
    "To All Scenes": "In alle Szenen",
    "Reset Settings": "Einstellungen zurücksetzen",
    # Operators
    "Mend Scene for Indirect Light": "Szene für indirektes Licht richten",
    "Repair Indirect Light": "Indirektes Licht reparieren",
    "Put back what Indirect Light needs: the helper scene, the passes and the nodes in the compositor": "Wiederherstellen, was indirektes Licht braucht: die Hilfsszene, die Passes und die Nodes im Compositor",
    "Copy Indirect Light Settings": "Einstellungen des indirekten Lichts kopieren",
    "Give this scene's settings of Indirect Light to other scenes, as they are in this frame: keyframes and drivers "
    "stay here": "Anderen Szenen die Einstellungen des indirekten Lichts dieser Szene geben, wie sie in diesem Einzelbild "
    "sind: Schlüsselbilder und Treiber bleiben hier",
    "Scene": "Szene",
    "The scene that gets the settings, all other scenes where empty": "Die Szene, die die Einstellungen bekommt; alle anderen, wo leer",
    "Tick Too": "Auch einschalten",
    "Tick Indirect Light in those scenes as well": "Indirektes Licht in diesen Szenen auch einschalten",
    "Settings copied to {}": "Einstellungen kopiert nach {}",
    '"{}" does not lie in a folder of Indirect Light presets, and is not run. Choose one from the panel\'s list of presets': "„{}“ liegt in keinem Ordner für Voreinstellungen des indirekten Lichts und wird nicht ausgeführt. Eine aus der "
    "Liste der Voreinstellungen im Panel wählen",
    "The preset has an error, and the settings stay as they were: {}": "Die Voreinstellung hat einen Fehler, und die Einstellungen bleiben, wie sie waren: {}",
    'There is no preset "{}"': "Es gibt keine Voreinstellung „{}“",
    "The preset could not be written ({}). Free some space on the disk of Blender's user folder, or allow writing there": "Die Voreinstellung ließ sich nicht schreiben ({}). Auf dem Datenträger von Blenders Benutzerordner Platz schaffen oder das "
    "Schreiben dort erlauben",
    'There is no other scene "{}" that can be changed': 'Es gibt keine andere Szene "{}", die sich ändern lässt',
    "The file has no other scene that can be changed": "Die Datei hat keine andere Szene, die sich ändern lässt",
    "The scene is linked from another file and can't be changed here": "Die Szene ist aus einer anderen Datei verknüpft und lässt sich hier nicht ändern",
    "Reset Indirect Light Settings": "Einstellungen des indirekten Lichts zurücksetzen",
    "Set everything in this panel but its checkbox to the defaults. Keyframes and drivers stay": "Alles in diesem Panel außer seinem Häkchen auf die Standardwerte setzen. Schlüsselbilder und Treiber bleiben",
    '{} of "{}" has keyframes or a driver, which set it again in every frame': '{} von "{}" hat Schlüsselbilder oder einen Treiber, die es in jedem Einzelbild neu setzen',
    "Indirect Light Help": "Hilfe zum indirekten Licht",
    "Show the page of help that came with the extension in the web browser. It needs no network": "Die mitgelieferte Hilfeseite im Webbrowser zeigen (englisch). Sie braucht kein Netz",
    "Help is in {}": "Die Hilfe liegt in {}",
    "Load Indirect Light Preset": "Voreinstellung für indirektes Licht laden",
    "Set everything in this panel but Strength and Seed as the preset has it": "Alles in diesem Panel außer Stärke und Startwert so setzen, wie es die Voreinstellung hat",
    "To set up the light of a shot: 4 views at most, 3 bounces. Its light is off by 14 % in the sample scenes, "
    "where EEVEE's ray tracing at its best is off by 61 %. Without a graphics card a frame takes 2.5 times as long "
    "as EEVEE's own 16 samples": "Um das Licht einzurichten: höchstens 4 Ansichten, 3 Reflexionen. Das Licht liegt in den Beispielszenen um 14 %"
    " daneben, EEVEEs Raytracing im besten Fall um 61 %. Ohne Grafikkarte dauert ein Bild 2,5-mal so lange wie "
    "EEVEEs eigene 16 Samples",
    "As the paper has it: one bounce between what the camera sees, through whatever stands in between, and no "
    "further views. Its light is off by 60 % in the sample scenes; a frame takes hardly longer than EEVEE's own": "Wie im Fachartikel: eine Reflexion zwischen dem, was die Kamera sieht, durch alles Dazwischenliegende "
    "hindurch, und keine weiteren Ansichten. Das Licht liegt in den Beispielszenen um 60 % daneben; ein Bild dauert"
    " kaum länger als mit EEVEE allein",
    "For final pictures: 7 views at most, 4 bounces. Its light is off by 10 % in the sample scenes, where EEVEE's "
    "ray tracing at its best is off by 61 %. Without a graphics card a frame takes 3.2 times as long as EEVEE's own"
    " 16 samples": "Für fertige Bilder: höchstens 7 Ansichten, 4 Reflexionen. Das Licht liegt in den Beispielszenen um 10 % "
    "daneben, EEVEEs Raytracing im besten Fall um 61 %. Ohne Grafikkarte dauert ein Bild 3,2-mal so lange wie "
    "EEVEEs eigene 16 Samples",
    "To judge the others by: 9 views at most, 8 bounces, four times the draws, and every pixel gathers for itself": "Um die anderen zu beurteilen: höchstens 9 Ansichten, 8 Reflexionen, viermal so viele Ziehungen, und jeder "
    "Pixel sammelt für sich",
    "Add Indirect Light Preset": "Voreinstellung für indirektes Licht hinzufügen",
    "Keep the settings of Indirect Light as a preset, or remove one": "Die Einstellungen des indirekten Lichts als Voreinstellung behalten oder eine entfernen",
    "Update Indirect Light": "Indirektes Licht aktualisieren",
    "Gather the light of the last render again with the settings as they are now, and composite the picture. EEVEE "
    "does not render again, so what changed in the scene since does not show": "Das Licht des letzten Renderns mit den jetzigen Einstellungen neu sammeln und das Bild zusammensetzen. EEVEE "
    "rendert nicht noch einmal; was sich seither in der Szene geändert hat, zeigt sich nicht",
    "Free Kept Passes": "Behaltene Passes freigeben",
    "Remove the passes of the last render from the temporary folder, where they are kept until Blender ends. Updating "
    "the light then needs another render": "Die Passes des letzten Renderns aus dem Ordner für temporäre Dateien entfernen, wo sie bis zum Ende von "
    "Blender bleiben. Das Licht zu aktualisieren braucht dann ein neues Rendern",
    "Tick Indirect Light first": "Zuerst Indirekte Beleuchtung einschalten",
    "A render is going on": "Es wird gerade gerendert",
    "There is no render of this scene to light again. Press F12 first": "Von dieser Szene ist nichts gerendert, was neu beleuchtet werden könnte. Zuerst F12 drücken",
    "The kept passes were deleted from the temporary folder. Press F12": "Die behaltenen Passes wurden aus dem Ordner für temporäre Dateien gelöscht. F12 drücken",
    "The light is gathered from EEVEE's passes. Set Render Engine to EEVEE": "Das Licht wird aus EEVEEs Passes gesammelt. Die Renderengine auf EEVEE setzen",
    "The resolution or the render region has changed since the last render. Press F12": "Auflösung oder Renderbereich haben sich seit dem letzten Rendern geändert. F12 drücken",
    "View layers were added or renamed since the last render. Press F12": "Seit dem letzten Rendern kamen Ansichtsebenen hinzu oder wurden umbenannt. F12 drücken",
    # What mends a scene
    "Repair": "Reparieren",
    "Set Render Engine to EEVEE": "Renderengine auf EEVEE setzen",
    "Render this scene with EEVEE. The settings of the other engine are kept": "Diese Szene mit EEVEE rendern. Die Einstellungen der anderen Engine bleiben",
    "Use a Camera of the Scene": "Eine Kamera der Szene nehmen",
    "Look through the first camera that the scene holds": "Durch die erste Kamera schauen, die die Szene hat",
    "Set Lens Type to Perspective": "Lens Type auf Perspektive setzen",
    "Make the camera an ordinary one. Its panorama's settings are kept": "Die Kamera zu einer gewöhnlichen machen. Die Einstellungen des Panoramas bleiben",
    "Render This View Layer": "Diese Ansichtsebene rendern",
    "Tick Use for Rendering of the view layer that the window shows": "Benutze zum rendern bei der Ansichtsebene einschalten, die das Fenster zeigt",
    "Turn Off Stereoscopy": "Stereoskopie ausschalten",
    "Render one view, that of the scene's camera": "Eine Ansicht rendern, die der Kamera der Szene",
    "Render All View Layers": "Alle Ansichtsebenen rendern",
    "Untick Render Single Layer. The render then takes as long as all view layers that are used": "Eine Ebene rendern ausschalten. Das Rendern dauert dann so lange wie alle verwendeten Ansichtsebenen",
    "Render the Scene": "Die Szene rendern",
    "Untick Sequencer in Output properties > Post Processing. The strips are kept": "Sequenzer in den Ausgabe-Eigenschaften > Nachbearbeitung ausschalten. Die Streifen bleiben",
    "Turn Off Ray Tracing": "Raytracing ausschalten",
    "Turn off EEVEE's ray tracing, so that bounced light is counted once. Its reflections and refractions go too": "EEVEEs Raytracing ausschalten, damit reflektiertes Licht nur einmal zählt. Seine Spiegelungen und Brechungen "
    "entfallen auch",
    "Disable Volumes in Renders": "Volumen in Renderings deaktivieren",
    "Leave the light probe volumes out of renders. Their bakes are kept": "Die Lichtproben-Volumen aus Renderings heraushalten. Was in ihnen gebacken ist, bleibt",
    "Show That Scene": "Jene Szene zeigen",
    "Show the scene that this one serves to light in this window": "In diesem Fenster die Szene zeigen, deren Licht diese hier dient",
    "Add Render Layers Node": "Render-Ebenen-Node hinzufügen",
    "Add a Render Layers node of this scene at the top level of the compositor, so that Blender renders it": "Auf der obersten Ebene des Compositors einen Render-Ebenen-Node dieser Szene hinzufügen, damit Blender sie "
    "rendert",
    # What is wrong with a scene
    "This scene served to light another, or is a copy of one that does. Nothing needs it: it can be deleted": "Diese Szene diente dem Licht einer anderen oder ist die Kopie einer solchen. Nichts braucht sie: sie kann gelöscht werden",
    "Indirect Light was ticked, or a setting that changes its nodes was changed, in the middle of a render: it takes effect with the "
    "next one. Scripts should do that before the render begins": "Mitten in einem Rendering wurde indirektes Licht eingeschaltet oder eine Einstellung geändert, die seine Nodes ändert: das "
    "wirkt ab dem nächsten. Skripte sollten das tun, bevor das Rendern beginnt",
    "Indirect Light was ticked in the middle of a render: it takes effect with the next one": "Indirektes Licht wurde mitten in einem Rendering eingeschaltet: es wirkt ab dem nächsten",
    "Indirect Light was unticked in the middle of a render: the frames from {} on are plain": "Indirektes Licht wurde mitten in einem Rendering ausgeschaltet: ab Bild {} sind die Bilder ohne Licht",
    "The image is no longer linked to the node that adds the light to it": "Das Bild ist nicht mehr mit dem Node verbunden, der ihm das Licht hinzufügt",
    'The compositor uses the Image of no Render Layers node of "{}", so the light is added to nothing. Link the Image of one, or the '
    "output Indirect of Afterlight's": 'Der Compositor nutzt das Bild keines Render-Ebenen-Nodes von "{}", also kommt das Licht in kein Bild. Das Bild von einem '
    "verbinden oder den Ausgang Indirect desjenigen von Afterlight",
    'This scene only serves to light "{}". Render that one': 'Diese Szene dient nur dem Licht von "{}". Jene rendern',
    "Indirect Light works on EEVEE's passes, and the render engine is {}. Set Render Engine to EEVEE, or untick "
    "Indirect Light": "Indirektes Licht braucht EEVEEs Passes, und die Renderengine ist {}. Die Renderengine auf EEVEE setzen oder "
    "indirektes Licht ausschalten",
    "The scene has no camera. Choose one in the Scene properties": "Die Szene hat keine Kamera. In den Szenen-Eigenschaften eine wählen",
    "The scene has no camera. Add one (Add > Camera) and make it the scene's camera": "Die Szene hat keine Kamera. Eine hinzufügen (Hinzufügen > Kamera) und zur Kamera der Szene machen",
    'The scene looks through "{}", which is no camera. Choose a camera in the Scene properties': 'Die Szene schaut durch "{}", und das ist keine Kamera. In den Szenen-Eigenschaften eine Kamera wählen',
    'The camera "{}" is panoramic. Set its Lens Type to Perspective or Orthographic': 'Die Kamera "{}" ist panoramisch. Ihren Lens Type auf Perspektive oder Orthografisch setzen',
    "No view layer is rendered. Tick Use for Rendering in the View Layer properties": "Keine Ansichtsebene wird gerendert. Benutze zum rendern in den Eigenschaften der Ansichtsebene einschalten",
    "Stereo and multi-view renders are not supported. Untick Stereoscopy in the Output properties": "Stereo und mehrere Ansichten werden nicht unterstützt. Stereoskopie in den Ausgabe-Eigenschaften ausschalten",
    "Render Single Layer is on, and with it Blender leaves out the scene that gathers the light. Untick it in the "
    "View Layer properties": "Eine Ebene rendern ist an, und damit lässt Blender die Szene aus, die das Licht sammelt. Es in den "
    "Eigenschaften der Ansichtsebene ausschalten",
    "The Video Sequencer's strips are rendered instead of the scene. Untick Sequencer in Output properties > Post "
    "Processing, or render the scene without strips": "Statt der Szene werden die Streifen des Video-Sequenzers gerendert. Sequenzer in den Ausgabe-Eigenschaften > "
    "Nachbearbeitung ausschalten oder die Szene ohne Streifen rendern",
    "EEVEE's ray tracing already adds bounced light: ours would count it twice": "EEVEEs Raytracing fügt schon reflektiertes Licht hinzu: mit unserem zählte es doppelt",
    "Light probe volumes hold bounced light once they are baked, and ours comes on top. Disable them in renders, or "
    "free their bakes": "Gebackene Lichtproben-Volumen enthalten reflektiertes Licht, und unseres kommt dazu. Sie in Renderings "
    "deaktivieren oder das Gebackene freigeben",
    "These settings were saved by Afterlight {}, and this is {}. What this version does not know is kept in the file, "
    "but has no effect": "Diese Einstellungen hat Afterlight {} gespeichert, und dies ist {}. Was diese Version nicht kennt, bleibt in "
    "der Datei, hat aber keine Wirkung",
    "Afterlight's helper scene was deleted or changed": "Die Hilfsszene von Afterlight wurde gelöscht oder geändert",
    "Compositing is switched off, so the light can't be added to the picture": "Compositing ist ausgeschaltet; das Licht kann nicht ins Bild kommen",
    "View layers were added, removed or renamed since Indirect Light was ticked": "Seit indirektes Licht eingeschaltet wurde, kamen Ansichtsebenen hinzu, gingen weg oder wurden umbenannt",
    'The compositor has no Render Layers node of "{}", so there is no picture to add light to. Add one and link its '
    "Image": 'Der Compositor hat keinen Render-Ebenen-Node von "{}", also kein Bild, in das Licht kommen könnte. Einen '
    "hinzufügen und sein Bild verbinden",
    'All Render Layers nodes of "{}" are muted, so there is no picture to add light to. Unmute one': 'Alle Render-Ebenen-Nodes von "{}" sind stumm, also gibt es kein Bild, in das Licht kommen könnte. Einen davon einschalten',
    "All Render Layers nodes of this scene are inside node groups, and then Blender does not render the scene. Add "
    "one at the top level of the compositor; it need not be linked": "Alle Render-Ebenen-Nodes dieser Szene sind in Node-Gruppen, und dann rendert Blender die Szene nicht. Auf "
    "der obersten Ebene des Compositors einen hinzufügen; verbunden sein muss er nicht",
    "The node that adds the light to {} was deleted, and the links of the image with it. Link the Image of its Render "
    "Layers node again": "Der Node, der {} das Licht hinzufügt, wurde gelöscht und mit ihm die Verbindungen des Bildes. Das Bild des "
    "Render-Ebenen-Nodes neu verbinden",
    "The compositor uses {} without the indirect light: a node of Afterlight was deleted, or a Render Layers node is "
    "new": "Der Compositor nimmt {} ohne das indirekte Licht: ein Node von Afterlight wurde gelöscht, oder ein "
    "Render-Ebenen-Node ist neu",
    "Afterlight's Render Layers node was deleted from the compositor": "Der Render-Ebenen-Node von Afterlight wurde aus dem Compositor gelöscht",
    "The indirect light is no longer linked to the node that adds it": "Das indirekte Licht ist nicht mehr mit dem Node verbunden, der es hinzufügt",
    "A pass that Afterlight reads was switched off": "Ein Pass, den Afterlight liest, wurde ausgeschaltet",
    # What can go wrong in a render
    "Afterlight (used by its helper scenes)": "Afterlight (für seine Hilfsszenen)",
    "Afterlight: the picture has no indirect light": "Afterlight: Das Bild hat kein indirektes Licht",
    "This engine works for Afterlight's helper scenes only. Set Render Engine to EEVEE and tick Indirect Light": "Diese Engine dient nur den Hilfsszenen von Afterlight. Die Renderengine auf EEVEE setzen und indirektes "
    "Licht einschalten",
    "Afterlight met an error of its own ({}). The terminal has the details; please report them": "Afterlight hat einen eigenen Fehler ({}). Im Terminal stehen die Einzelheiten; bitte melden",
    "Afterlight: {} pixels of {} in {} are NaN or infinite. They send no indirect light; look for a material that "
    "divides by zero or a light of unbounded strength": "Afterlight: {} Pixel von {} in {} sind NaN oder unendlich. Sie senden kein indirektes Licht; nach einem "
    "Material suchen, das durch null teilt, oder einem Licht ohne Grenze",
    'There is no render of "{}" to light. Render that one, not the scene that serves to light it': 'Von "{}" ist nichts gerendert. Jene Szene rendern, nicht die, die ihrem Licht dient',
    "The passes could not be written to {} ({}). Free some space there, or choose another folder in Preferences > "
    "File Paths > Temporary Files and restart Blender": "Die Passes ließen sich nicht nach {} schreiben ({}). Dort Platz schaffen oder in Benutzereinstellungen > "
    "Dateipfade > Temporäre Dateien einen anderen Ordner wählen und Blender neu starten",
    "The passes could not be read back from {} ({}). The disk of the temporary folder may be full": "Die Passes ließen sich nicht aus {} zurücklesen ({}). Der Datenträger des Ordners für temporäre Dateien ist "
    "vielleicht voll",
    "The render has no pass {}. Press Repair in the Indirect Light panel, then render again": "Dem Rendering fehlt der Pass {}. Im Panel Indirekte Beleuchtung auf Reparieren drücken und neu rendern",
    "The OpenEXR module can't be imported ({}). It comes with the extension: remove Afterlight in Preferences > Get "
    "Extensions and install it again from its zip": "Das Modul OpenEXR lässt sich nicht laden ({}). Es gehört zur Erweiterung: Afterlight in "
    "Benutzereinstellungen > Get Extensions entfernen und aus seinem Zip neu installieren",
    "The frame needs a texture of {} x {}, but this GPU's largest is {} x {}. Lower the render resolution": "Das Bild braucht eine Textur von {} x {}, doch die größte dieser GPU ist {} x {}. Die Renderauflösung senken",
    "Blender has no GPU here. In background mode it needs a graphics driver; on a machine without a display, install "
    "Mesa's software driver": "Blender hat hier keine GPU. Im Hintergrund braucht es einen Grafiktreiber; auf einem Rechner ohne Bildschirm "
    "Mesas Softwaretreiber installieren",
    "The GPU has no memory for a texture of {} x {}. Use a coarser start resolution, or lower the render resolution": "Die GPU hat keinen Speicher für eine Textur von {} x {}. Eine gröbere Startauflösung nehmen oder die "
    "Renderauflösung senken",
    "The GPU driver cannot compile the shader '{}'. Update the graphics driver, or try Blender's other GPU backend in "
    "the preferences": "Der Grafiktreiber kann den Shader '{}' nicht übersetzen. Den Treiber aktualisieren oder in den "
    "Benutzereinstellungen Blenders anderes GPU-Backend versuchen",
    # Radiosity and its views
    "Method": "Verfahren",
    "How the light is gathered: how close it comes to Cycles, and what it costs": "Wie das Licht gesammelt wird: wie nah es Cycles kommt und was es kostet",
    "Paper": "Paper",
    "One bounce between the surfaces that the camera sees, through whatever stands between them: the fastest": "Eine Reflexion zwischen den Flächen, die die Kamera sieht, durch alles hindurch, was zwischen ihnen steht: "
    "am schnellsten",
    "Radiosity": "Radiosity",
    "Several bounces between the surfaces that all views see, which hide one another: the closest to Cycles": "Mehrere Reflexionen zwischen den Flächen, die alle Ansichten sehen und die einander verdecken: am nächsten "
    "an Cycles",
    "Draws": "Ziehungen",
    "Emitters that a texel looks at, each chosen among sixteen. Time grows in proportion, noise falls with the "
    "square root": "Strahler, zu denen ein Texel blickt, jeder aus sechzehn gewählt. Die Zeit wächst im gleichen Verhältnis, "
    "das Rauschen sinkt mit der Wurzel",
    "Bounces": "Reflexionen",
    "How often light is passed on from surface to surface. Rooms with bright walls want more. Each adds a little "
    "time, the same for pictures of any size": "Wie oft das Licht von Fläche zu Fläche weitergeht. Räume mit hellen Wänden brauchen mehr. Jede kostet ein "
    "wenig Zeit, für Bilder jeder Größe gleich viel",
    "Visibility": "Verdeckung",
    "Let surfaces hide what lies behind them. Without, light passes through everything, rooms with furniture get too "
    "bright, and the gather takes about half the time": "Flächen verdecken lassen, was hinter ihnen liegt. Ohne dies geht Licht durch alles hindurch, Räume mit "
    "Möbeln werden zu hell, und das Sammeln braucht etwa die halbe Zeit",
    # Views
    "Views": "Ansichten",
    "View": "Ansicht",
    "Camera": "Kamera",
    "Cameras": "Kameras",
    "The views, where they are manual": "Die Ansichten, wo sie von Hand gewählt sind",
    "A camera that sees surfaces which light the picture. The place of a lamp is a good one": "Eine Kamera, die Flächen sieht, welche das Bild beleuchten. Der Ort einer Lampe eignet sich gut",
    "Which cameras see the surfaces that send light: what none of them sees sends none. Each further view costs the time "
    "of one sample of EEVEE": "Welche Kameras die Flächen sehen, die Licht senden: was keine sieht, sendet keines. Jede weitere Ansicht kostet die "
    "Zeit eines Samples von EEVEE",
    "Camera Only": "Nur Kamera",
    "Only the picture itself: the fastest, without light from outside it": "Nur das Bild selbst: am schnellsten, ohne Licht von außerhalb",
    "Automatic": "Automatisch",
    "Views are placed in every shot where they see most of what is missing": "In jeder Einstellung werden Ansichten dort aufgestellt, wo sie am meisten von dem sehen, was fehlt",
    "Manual": "Von Hand",
    "The cameras that you list": "Die Kameras der Liste",
    "Views at Most": "Höchstzahl der Ansichten",
    "How many views are placed at most. Fewer are placed, at less cost, where a further one would see little that is new": "Wie viele Ansichten höchstens aufgestellt werden. Wo eine weitere kaum Neues sähe, sind es weniger, und es kostet "
    "weniger",
    "Keep Views as Cameras": "Ansichten als Kameras behalten",
    "Make a camera for each view of the last render and list them, to see, adjust and keep them: they are the same in "
    "every frame and on every computer of a farm from then on": "Für jede Ansicht des letzten Renderns eine Kamera anlegen und in die Liste setzen, um sie zu sehen, zu ändern und "
    "zu behalten: von da an sind sie in jedem Frame und auf jedem Rechner einer Renderfarm dieselben",
    "Add View": "Ansicht hinzufügen",
    "Add the selected cameras to the list of views, or an empty line where none is selected": "Die ausgewählten Kameras in die Liste der Ansichten setzen, oder eine leere Zeile, wo keine ausgewählt ist",
    "Remove View": "Ansicht entfernen",
    "Take the active line out of the list of views. The camera stays in the scene": "Die aktive Zeile aus der Liste der Ansichten nehmen. Die Kamera bleibt in der Szene",
    "Seen by the Camera": "Von der Kamera gesehen",
    "The last render had {} further views, and there are {} in the settings now. Press F12 for the light from all of them": "Das letzte Rendern hatte {} weitere Ansichten, in den Einstellungen sind es jetzt {}. F12 drücken für das Licht aus "
    "allen",
    "Seen with {} Views": "Mit {} Ansichten gesehen",
    "Placing": "Aufstellen",
    "There can be {} views at most": "Es kann höchstens {} Ansichten geben",
    "No views have been placed in this scene. Set Views to Automatic and render": "In dieser Szene wurden noch keine Ansichten aufgestellt. Ansichten auf Automatisch stellen und rendern",
    "Afterlight's views (used by its helper scenes)": "Ansichten von Afterlight (für dessen Hilfsszenen)",
    "No views were placed: no surface lights what the camera sees": "Es wurden keine Ansichten aufgestellt: keine Fläche beleuchtet, was die Kamera sieht",
    "No views were placed: there is no free place that shows more than the camera does": "Es wurden keine Ansichten aufgestellt: kein freier Ort zeigt mehr als die Kamera",
    'The view "{}" sees no surface that lights the picture, and is left out. It may be inside a wall, or look away. Move '
    "it, or remove it from the list": "Die Ansicht „{}“ sieht keine Fläche, die das Bild beleuchtet, und bleibt weg. Vielleicht steckt sie in einer Wand "
    "oder blickt in eine andere Richtung. Sie versetzen oder aus der Liste nehmen",
    "A view in the list has no camera. Choose one, or remove the line": "Eine Ansicht in der Liste hat keine Kamera. Eine wählen oder die Zeile entfernen",
    'The view "{}" is no camera, and is left out. Choose a camera in its place': "Die Ansicht „{}“ ist keine Kamera und bleibt weg. An ihrer Stelle eine Kamera wählen",
    'The view "{}" is panoramic, and is left out. Set its Lens Type to Perspective or Orthographic': "Die Ansicht „{}“ ist ein Panorama und bleibt weg. Ihren Linsentyp auf Perspektivisch oder Orthografisch stellen",
    "A view could not be used: {}": "Eine Ansicht konnte nicht verwendet werden: {}",
    "A scene through which Afterlight renders its views, or its node in the compositor, was deleted": "Eine Szene, durch die Afterlight seine Ansichten rendert, oder ihr Node im Compositor wurde gelöscht",
}
